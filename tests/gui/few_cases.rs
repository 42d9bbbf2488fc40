//! Data sets of few cases, for tests in which nothing follows from how many there are.

use std::fs;
use std::path::Path;

/// Copies the first cases of a shipped data set, and returns the path of the copy. It has the name of the data
/// set.
pub fn few_cases(folder: &Path, name: &str, n_cases: usize) -> String {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets").join(name);
    let copy = folder.join(name);
    let table = fs::read_to_string(shipped.join("cases.csv")).expect("a shipped table");
    let rows: Vec<&str> = table.lines().take(1 + n_cases).collect();
    let is_there = |of: &&str| shipped.join(of).is_dir();
    let series = ["forces", "trajectories"].into_iter().find(is_there).expect("a data set");
    fs::create_dir_all(copy.join(series)).expect("a folder");
    fs::write(copy.join("cases.csv"), rows.join("\n") + "\n").expect("a table");
    let cases = rows.iter().skip(1).filter_map(|row| row.split(',').next());
    let files = cases.map(|case| format!("{series}/{case}.csv"));
    let vehicle = shipped.join("vehicle.toml").is_file().then(|| "vehicle.toml".to_owned());
    for file in files.chain(vehicle) {
        fs::copy(shipped.join(&file), copy.join(&file)).expect("a file of the data set");
    }
    copy.display().to_string()
}
