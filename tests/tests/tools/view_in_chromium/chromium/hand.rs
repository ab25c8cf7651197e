//! What an operator does to a page: pointing, pressing keys, touching, holding a phone.

use super::Chromium;
use serde_json::{Value, json};

impl Chromium {
    /// Opens a page and waits until it is drawn.
    pub fn show(&mut self, file: &std::path::Path) {
        self.open(file);
        self.wait_for("window.grainpipe?.ready === true");
    }

    /// A number that the page computes.
    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.value(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}, not a number"))
    }

    /// A text that the page computes.
    pub fn text(&mut self, expression: &str) -> String {
        let value = self.value(expression);
        value.as_str().unwrap_or_else(|| panic!("{expression} is {value}, not a text")).to_owned()
    }

    /// Presses the left button at one place of the window and lets go of it at another [pixel].
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        let mut event = |kind: &str, [x, y]: [f64; 2], buttons: u8| {
            let params =
                json!({"type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1});
            self.call("Input.dispatchMouseEvent", params);
        };
        event("mouseMoved", from, 0);
        event("mousePressed", from, 1);
        if from != to {
            event("mouseMoved", [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])], 1);
            event("mouseMoved", to, 1);
        }
        event("mouseReleased", to, 0);
    }

    /// Clicks.
    pub fn click(&mut self, at: [f64; 2]) {
        self.drag(at, at);
    }

    /// Presses a key.
    pub fn key(&mut self, key: &str) {
        self.value(&format!("dispatchEvent(new KeyboardEvent('keydown', {{ key: {} }}))", json!(key)));
    }

    /// Touches with as many fingers as there are places, one after the other.
    pub fn touch(&mut self, steps: &[&[[f64; 2]]]) {
        for (n, places) in steps.iter().enumerate() {
            let points: Vec<Value> =
                places.iter().enumerate().map(|(id, [x, y])| json!({"x": x, "y": y, "id": id})).collect();
            let kind = if n == 0 { "touchStart" } else { "touchMove" };
            self.call("Input.dispatchTouchEvent", json!({"type": kind, "touchPoints": points}));
        }
        self.call("Input.dispatchTouchEvent", json!({"type": "touchEnd", "touchPoints": []}));
    }

    /// A window of that size [pixel], of a phone or not.
    pub fn window(&mut self, width: u32, height: u32, phone: bool) {
        let scale = if phone { 2 } else { 1 };
        let size = json!({"width": width, "height": height, "deviceScaleFactor": scale, "mobile": phone});
        self.call("Emulation.setDeviceMetricsOverride", size);
        self.call("Emulation.setTouchEmulationEnabled", json!({"enabled": phone}));
    }

    /// Nothing went wrong, and nothing was asked for but the page itself.
    pub fn assert_calm(&mut self) {
        assert_eq!(self.value("grainpipe.glError"), json!(0));
        assert!(self.problems().is_empty(), "{:?}", self.problems());
        let requests = self.requests();
        assert!(requests.iter().all(|r| r.starts_with("file://") || r.starts_with("blob:")), "{requests:?}");
    }
}
