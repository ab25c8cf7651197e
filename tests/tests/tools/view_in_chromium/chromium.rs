//! A headless Chromium, spoken to through its debugging pipe: JSON messages that end in a zero byte.

mod hand;

use serde_json::{Value, json};
use std::{
    io::{BufRead, BufReader, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc::{Receiver, channel},
    time::{Duration, Instant},
};
use tempfile::TempDir;
use view::Page;

/// How long to wait for any answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// Chromium, where it is installed: `$CHROMIUM`, or the first of the usual names on the path.
pub fn find() -> Option<PathBuf> {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let usual = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    named.into_iter().chain(usual).find(|path| path.is_file())
}

/// A running browser with one page.
pub struct Chromium {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    session: Value,
    asked: u64,
    /// What the page reported without being asked.
    pub events: Vec<Value>,
    _profile: TempDir,
    /// Folder of the page.
    _page: Option<TempDir>,
}

/// Writes a page into a separate folder.
pub fn written(name: &str, page: &Page) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, page.html().expect("a page")).expect("written");
    (folder, file)
}

impl Chromium {
    /// Starts it, and shows a page that lies in a folder; nothing where it is not installed.
    pub fn showing(page: impl FnOnce() -> (TempDir, PathBuf)) -> Option<Chromium> {
        let Some(program) = find() else {
            grainpipe_tests::skip("chromium");
            return None;
        };
        let (folder, file) = page();
        let mut browser = Chromium::start(&program, &[]);
        browser.show(&file);
        browser._page = Some(folder);
        Some(browser)
    }

    /// Starts it with more arguments, and watches the page's requests and errors.
    pub fn start(program: &Path, more: &[&str]) -> Chromium {
        let profile = tempfile::tempdir().expect("a folder for the profile");
        // The debugging pipe is file descriptors 3 and 4; the shell makes them of stdin and stdout.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null 2>&1", "sh"])
            .arg(program)
            .args([
                "--headless",
                "--no-sandbox",
                "--remote-debugging-pipe",
                "--no-first-run",
                "--window-size=480,360",
            ])
            .args(["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .args(more)
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let to = child.stdin.take().expect("piped");
        let mut out = BufReader::new(child.stdout.take().expect("piped"));
        let (send, from) = channel();
        std::thread::spawn(move || {
            let mut message = Vec::new();
            while out.read_until(0, &mut message).is_ok_and(|n| n > 0) {
                message.pop();
                let Ok(value) = serde_json::from_slice(&message) else { break };
                if send.send(value).is_err() {
                    break;
                }
                message.clear();
            }
        });
        let mut browser = Chromium {
            child,
            to,
            from,
            session: Value::Null,
            asked: 0,
            events: vec![],
            _profile: profile,
            _page: None,
        };
        browser.attach();
        browser
    }

    fn attach(&mut self) {
        let targets = self.call("Target.getTargets", json!({}));
        let targets = targets["targetInfos"].as_array().expect("a list");
        let page = targets.iter().find(|t| t["type"] == "page").expect("a page")["targetId"].clone();
        let session = self.call("Target.attachToTarget", json!({ "targetId": page, "flatten": true }));
        self.session = session["sessionId"].clone();
        for domain in ["Page", "Runtime", "Network", "Log"] {
            self.call(&format!("{domain}.enable"), json!({}));
        }
    }

    /// Asks for something and waits for the answer.
    pub fn call(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let mut message = json!({ "id": self.asked, "method": method, "params": params });
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        write!(self.to, "{message}\0").and_then(|()| self.to.flush()).expect("chromium reads");
        loop {
            let answer = self.from.recv_timeout(PATIENCE).unwrap_or_else(|e| panic!("{method}: {e}"));
            if answer["id"] == self.asked {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
            self.events.push(answer);
        }
    }

    /// The value of a JavaScript expression in the page.
    pub fn value(&mut self, expression: &str) -> Value {
        let answer =
            self.call("Runtime.evaluate", json!({ "expression": expression, "returnByValue": true }));
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    pub fn wait_for(&mut self, expression: &str) {
        let start = Instant::now();
        while self.value(expression) != json!(true) {
            assert!(start.elapsed() < PATIENCE, "never true: {expression}; seen: {:?}", self.problems());
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Opens a file.
    pub fn open(&mut self, file: &Path) {
        self.call("Page.navigate", json!({ "url": format!("file://{}", file.display()) }));
    }

    /// Every address asked for so far.
    pub fn requests(&self) -> Vec<String> {
        let asked = self.events.iter().filter(|e| e["method"] == "Network.requestWillBeSent");
        asked.filter_map(|e| e["params"]["request"]["url"].as_str().map(str::to_owned)).collect()
    }

    /// Exceptions, warnings and errors that the page caused.
    pub fn problems(&self) -> Vec<&Value> {
        // The test itself reads pixels back, which the driver may remark on.
        let ours =
            |entry: &Value| entry["text"].as_str().is_some_and(|t| t.contains("GPU stall due to ReadPixels"));
        let bad = |e: &&Value| match e["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Log.entryAdded") => {
                let entry = &e["params"]["entry"];
                entry["level"] != "info" && !ours(entry)
            }
            Some("Runtime.consoleAPICalled") => e["params"]["type"] == "error",
            _ => false,
        };
        self.events.iter().filter(bad).collect()
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        self.session = Value::Null;
        let _ = write!(self.to, "{}\0", json!({ "id": 0, "method": "Browser.close" }));
        let _ = self.to.flush();
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(5) {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
