//! A batch script for Slurm.

use std::path::Path;

/// The script of a scene on so many ranks.
pub fn slurm(scene: &str, ranks: usize) -> String {
    let stem = Path::new(scene).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    format!(
        "#!/bin/bash\n#SBATCH --job-name={name}\n#SBATCH --ntasks={ranks}\n#SBATCH --output=slurm-%j.out\n\
         # Set the time limit and the partition of your cluster:  sbatch --time=12:00:00 --partition=NAME batch.sh\n\
         cd \"${{SLURM_SUBMIT_DIR:-.}}\"\nsrun ${{LMP:-lmp}} -in run.in\n\
         # Then, where Grainpipe is:  dem-lammps SCENE.toml --read-dump frames.dump -o run.mcap\n"
    )
}
