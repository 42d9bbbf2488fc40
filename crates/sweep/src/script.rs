//! The batch file of a sweep for Slurm.

use std::path::Path;

use crate::{Plan, SweepError};

/// Most tasks of an array: one less than what Slurm allows where nobody has set it.
pub const MOST_TASKS: u64 = 1000;

/// The tasks of the array of a plan.
pub fn n_tasks(plan: &Plan) -> u64 {
    plan.n_chunks().clamp(1, MOST_TASKS)
}

/// The batch file that runs the chunks of a plan as a job array and merges them.
///
/// - `folder`: of the plan, and `program`: as the nodes find them.
///
/// # Errors
/// [`SweepError::NoText`] for a path that is no text: another one would stand in the file.
pub fn slurm_script(plan: &Plan, folder: &Path, program: &Path) -> Result<String, SweepError> {
    let (tasks, chunks) = (n_tasks(plan), plan.n_chunks());
    let name = name_of_job(&plan.name);
    let (folder, program) = (word_of(folder)?, word_of(program)?);
    let last = tasks - 1;
    Ok(format!(
        "\
#!/bin/bash
# A sweep of {rows} rows in {chunks} chunks, by {tasks} tasks.
#
#   bash FILE              sends off the tasks, and a job that merges once they have ended
#   bash FILE 7,19-23      sends off these tasks again, and the merge after them
#   sbatch FILE            sends off the tasks alone
#
# A task that was killed leaves nothing half done: its chunk is missing, and those that are there are kept.
# The tasks with missing chunks are what this prints:
#   impactlab sweep status FOLDER --missing --stride {tasks}
# Whichever tasks run again, and wherever, the rows have the same bits.
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=1G
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --output=%x-%A_%a.log
set -euo pipefail

plan={folder}
impactlab={program}

if [ -z \"${{SLURM_JOB_ID:-}}\" ]; then
    if [ $# -gt 0 ] && [ -z \"$1\" ]; then
        echo \"no chunk is missing, and nothing was sent off\"
        exit
    fi
    job=$(sbatch --parsable --array=\"${{1:-0-{last}}}\" \"$0\")
    # Once all tasks have ended, however they have: it says which chunks are missing, if any are.
    merge=$(printf '%q ' \"$impactlab\" sweep merge \"$plan\" --out \"$plan/rows.parquet\" --overwrite)
    sbatch --dependency=\"afterany:${{job%%;*}}\" --job-name={name}-merge --output=%x-%j.log \\
        --ntasks=1 --mem-per-cpu=2G --wrap=\"$merge\"
    exit
fi

# Task t has the chunks t, t + {tasks}, t + {doubled} and so on.
export RAYON_NUM_THREADS=\"${{SLURM_CPUS_PER_TASK:-1}}\"
exec \"$impactlab\" sweep run \"$plan\" --array --stride {tasks}
",
        rows = plan.n_rows(),
        doubled = 2 * tasks,
    ))
}

/// A name that Slurm takes.
fn name_of_job(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let name: String = name.chars().map(plain).take(40).collect();
    let name = name.trim_matches('-');
    if name.is_empty() { "sweep".to_owned() } else { name.to_owned() }
}

/// A path as one word of a shell.
fn word_of(path: &Path) -> Result<String, SweepError> {
    let no_text = || SweepError::NoText { path: path.to_owned() };
    path.to_str().map(quoted).ok_or_else(no_text)
}

/// A text as one word of a shell.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_the_shell_stays_one_and_a_name_is_plain() {
        assert_eq!(quoted("a b'; rm -rf $x"), "'a b'\\''; rm -rf $x'");
        assert_eq!(name_of_job("PIT at 35 mph!"), "pit-at-35-mph");
        assert_eq!(name_of_job("\n#SBATCH"), "sbatch");
        assert_eq!(name_of_job("…"), "sweep");
    }

    /// The batch file named another folder, in which no task found a plan.
    #[cfg(unix)]
    #[test]
    fn a_path_that_is_no_text_is_refused() {
        use std::os::unix::ffi::OsStrExt as _;

        let folder = Path::new(std::ffi::OsStr::from_bytes(b"/sweeps/f\xff"));
        let refused = word_of(folder);
        assert!(
            matches!(&refused, Err(SweepError::NoText { path }) if path == folder),
            "{refused:?}"
        );
        assert_eq!(word_of(Path::new("/sweeps/a b")).unwrap(), "'/sweeps/a b'");
    }
}
