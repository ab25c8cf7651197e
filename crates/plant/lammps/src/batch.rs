//! A batch script for Slurm.

use crate::files::{DUMPS, FINISHED, OF_BODIES, STATES, WHOLE};
use std::path::Path;

/// The script of a scene on so many ranks; `rigid`: it has rigid bodies, whose file is written after the state.
pub fn slurm(scene: &str, ranks: usize, rigid: bool) -> String {
    let stem = Path::new(scene).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let ([a, b], length) = (STATES, WHOLE.len() + 1);
    let bodies = match rigid {
        true => format!(
            "  [ -e \"$state{OF_BODIES}\" ] && [ ! \"$state{OF_BODIES}\" -ot \"$state\" ] || continue\n  \
             # Its first line has the number of the others.\n  \
             awk '!/^#/ && NF {{ if (count == \"\") count = $1; else lines++ }} END {{ exit count == \"\" || count != lines + 0 }}' \"$state{OF_BODIES}\" || continue\n"
        ),
        false => String::new(),
    };
    let dumps = || DUMPS.iter().map(|dump| dump.trim_end_matches(".dump"));
    let names: String = dumps().map(|dump| format!(" -var {dump} \"{dump}-$part.dump\"")).collect();
    let old = dumps().map(|dump| format!("{dump}-*.dump")).collect::<Vec<_>>().join(" ");
    format!(
        "#!/bin/bash\n#SBATCH --job-name={name}\n#SBATCH --ntasks={ranks}\n#SBATCH --output=slurm-%j.out\n\
         # Set the time limit and the partition of your cluster:  sbatch --time=12:00:00 --partition=NAME batch.sh\n\
         cd \"${{SLURM_SUBMIT_DIR:-.}}\"\n\
         # Submitted again, it goes on from the newest state that is whole.\n\
         [ -e {FINISHED} ] && echo \"all steps are done\" && exit\n\
         options=() part=2\n\
         for state in $(ls -t {a} {b} 2> /dev/null); do\n  \
           tail -c {length} \"$state\" | tr -d '\\0' | grep -q '{WHOLE}' || continue\n{bodies}  \
           while [ -e \"frames-$part.dump\" ]; do part=$((part + 1)); done\n  \
           options=(-var state \"$state\"{names})\n  \
           break\n\
         done\n\
         [ ${{#options[@]}} -gt 0 ] || rm -f {old}\n\
         srun ${{LMP:-lmp}} -in run.in \"${{options[@]}}\"\n\
         # Then, where Grainpipe is:  dem-lammps SCENE.toml --read-dump frames.dump -o run.mcap\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_is_text() {
        let script = slurm("a plant.toml", 3, false);
        assert!(script.starts_with("#!/bin/bash\n#SBATCH --job-name=a-plant\n#SBATCH --ntasks=3\n"));
        assert!(DUMPS.iter().all(|dump| script.contains(&dump.replace(".dump", "-$part.dump"))));
        assert!(!script.contains('\0') && script.contains("tr -d '\\0'"), "Slurm refuses bytes of zero");
    }
}
