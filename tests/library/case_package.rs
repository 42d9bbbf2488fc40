//! Packages of cases: they open elsewhere with the same answers, and have nothing that nobody asked of.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{CrashTest, Existing};
use impactlab_study::case_file::{CaseError, CaseFile, Change, UsedModel, Variant, pack, unpack};
use impactlab_study::{CheckRequest, Event, EvidenceChoice, Library, ReconstructRequest, Request};

use crate::case_file::{case, folder, force_file};

/// A package had every file below a folder of data, also what nobody reads, and of a table nothing but itself.
#[test]
fn a_package_has_the_files_of_data_sets_and_nothing_that_lies_beside_them() {
    let folder = folder("data-sets");
    let data = folder.join("data");
    let lines = [
        ("set/cases.csv", "case,m1_kg,m2_kg,v1_m_s,v2_m_s,angle_deg\n1,1500,1500,10,14,10\n"),
        ("set/forces/1.csv", "t [s],Fx [N],Fy [N]\n0,0,0\n0.1,9,9\n0.2,0,0\n"),
        ("set/forces/letter.csv", "private"),
        ("set/forces/letter.txt", "private"),
        ("set/private-notes.txt", "private"),
        ("set/drafts/letter.txt", "private"),
        ("pairs/cases.csv", "case,target,bullet\na,golf,polo\n"),
        ("pairs/cases/a.csv", "t\n"),
        ("pairs/cases/b.csv", "private"),
        ("pairs/vehicles/golf.toml", ""),
        ("pairs/vehicles/zz.toml", "private = 1"),
        ("letters/letter.csv", "private"),
        ("private.csv", "private"),
    ];
    for (name, text) in lines {
        let path = data.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("written");
    }
    let case = |question: Request| {
        let variant =
            Variant { name: "base".to_owned(), questions: vec![question], ..Variant::default() };
        let mut case = CaseFile::new("a", variant);
        case.record_files();
        case
    };
    let check = |path: &str| {
        case(CheckRequest { paths: vec![data.join(path)], all: false, map: None }.into())
    };
    let names = |case: &CaseFile| -> Vec<String> {
        let zip = folder.join("a.zip");
        let packed = pack(case, &zip, Existing::Replace).expect("packed");
        let there = folder.join("there");
        let _ = fs::remove_dir_all(&there);
        let opened = CaseFile::load(&unpack(&zip, &there).expect("unpacked")).expect("loaded");
        assert_eq!(opened.changes(), []);
        // It is as much of a data set there as here.
        let answer = |case: &CaseFile| {
            let asked = case.ask(&[], &Library::default(), &mut |_| ControlFlow::Continue(()));
            let report = asked.expect("asked").complete().expect("answers");
            let report = serde_json::to_value(report).expect("JSON");
            report["variants"][0]["answers"][0]["report"]["datasets"].as_array().map(Vec::len)
        };
        assert_eq!(answer(&opened), answer(case));
        packed.into_iter().map(|file| file.name).collect()
    };
    let set = ["cases.csv", "forces/1.csv"];
    let pairs = ["cases.csv", "cases/a.csv", "vehicles/golf.toml"];
    let below = |folder: &str, files: &[&str]| -> Vec<String> {
        files.iter().map(|file| format!("files/0/{folder}{file}")).collect()
    };
    assert_eq!(names(&check("set")), below("set/", &set));
    assert_eq!(names(&check("set/cases.csv")), below("", &set));
    assert_eq!(names(&check("pairs")), below("pairs/", &pairs));
    let both = [below("data/pairs/", &pairs), below("data/set/", &set)].concat();
    assert_eq!(names(&check("")), both);
    let refused = |path: &str| {
        let zip = folder.join("refused.zip");
        let error = pack(&check(path), &zip, Existing::Refuse).expect_err("no data");
        assert!(!zip.exists());
        error.to_string()
    };
    let letters = refused("letters");
    assert!(letters.ends_with("letters: holds no data that the case uses"), "{letters}");
    let training = serde_json::json!({
        "question": "fine_tune", "data": [], "logs": {"logs": [data.join("letters")]},
    });
    let training: Request = serde_json::from_value(training).expect("a question");
    let packed = pack(&case(training), &folder.join("b.zip"), Existing::Refuse).expect("packed");
    assert_eq!(packed.len(), 1);
    assert_eq!(packed[0].name, "files/0/letters/letter.csv");
}

#[test]
fn a_package_opens_in_another_folder_with_the_same_answers() {
    let [here, there] = [folder("here"), folder("there")];
    let case = case(&force_file(&here));
    let zip = here.join("crossing.zip");
    pack(&case, &zip, Existing::Refuse).expect("packed");
    let opened = unpack(&zip, &there.join("case")).expect("unpacked");
    assert_eq!(opened, there.join("case/Crossing.impactlab"));
    fs::remove_dir_all(&here).expect("gone");
    let unpacked = CaseFile::load(&opened).expect("loaded");
    assert!(unpacked.changes().is_empty());
    let library = Library::default();
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let report = unpacked.ask(&[], &library, &mut go_on).expect("asked").complete();
    assert!(report.expect("answers").is_clean());
    // A folder that is there is left alone.
    let error = unpack(&opened, &there.join("case")).expect_err("exists");
    assert!(matches!(error, CaseError::FolderExists { .. }), "{error}");
    let error = unpack(&opened, &there.join("b")).expect_err("no zip");
    assert!(matches!(error, CaseError::Zip { .. }), "{error}");
    assert!(!there.join("b").exists());
}

#[test]
fn a_site_goes_with_everything_it_names_and_is_found_in_a_package() {
    let folder = folder("site");
    let road = folder.join("road");
    fs::create_dir_all(road.join("photos")).expect("a folder");
    let picture = image::RgbImage::from_pixel(40, 20, image::Rgb([90, 95, 100]));
    picture.save(road.join("photos/road.png")).expect("a picture");
    fs::write(road.join("photos/road.pgw"), "0.5\n0\n0\n-0.5\n0.25\n9.75\n").expect("written");
    let zone = "[[friction_zone]]\nname = \"ice\"\nfriction = 0.1\n\
                border_m = [[-50, -9], [90, -9], [90, 9], [-50, 9]]\n";
    let text = format!("[orthophoto]\nfile = \"photos/road.png\"\n{zone}");
    fs::write(road.join("site.toml"), text).expect("written");
    let mut case = case(&force_file(&folder));
    for variant in &mut case.variants {
        for question in &mut variant.questions {
            if let Request::Simulate(simulate) = question {
                simulate.site = Some(road.join("site.toml"));
            }
        }
    }
    case.record_files();
    let names = ["force.csv", "photos/road.pgw", "photos/road.png", "site.toml"];
    let used: Vec<String> = case
        .files
        .iter()
        .map(|file| file.path.strip_prefix(&road).unwrap_or(&file.path).display().to_string())
        .collect();
    assert!(names.iter().all(|name| used.iter().any(|path| path.ends_with(name))), "{used:?}");
    let package = folder.join("case.zip");
    // Without the orthophoto there is no package.
    let (photo, away) = (road.join("photos/road.png"), folder.join("away.png"));
    fs::rename(&photo, &away).expect("moved");
    let error = pack(&case, &package, Existing::Refuse).expect_err("incomplete");
    assert!(matches!(&error, CaseError::Missing { path } if *path == photo), "{error}");
    fs::rename(&away, &photo).expect("moved back");
    pack(&case, &package, Existing::Refuse).expect("packed");
    let unpacked = unpack(&package, &folder.join("unpacked")).expect("unpacked");
    let opened = CaseFile::load(&unpacked).expect("loaded");
    assert!(opened.changes().is_empty(), "{:?}", opened.changes());
    assert_eq!(opened.used_paths().len(), names.len(), "{:?}", opened.used_paths());
    fs::remove_dir_all(&road).expect("removed");
    let report = opened.ask(&[], &Library::default(), &mut |_| ControlFlow::Continue(()));
    let report = report.expect("asked").complete().expect("answers");
    assert!(report.is_clean(), "{report:?}");
    // A change of the orthophoto is a change of the case.
    let site = opened.used_paths().into_iter().find(|path| path.ends_with("site.toml"));
    let photo = site.expect("a site").parent().expect("a folder").join("photos/road.png");
    fs::write(&photo, "changed").expect("written");
    assert!(opened.changes().contains(&Change::Changed { path: photo }), "{:?}", opened.changes());
}

/// A package with a backslash in a name, or of a case with a long one, could not be unpacked, and one with a
/// colon not on Windows.
#[cfg(unix)]
#[test]
fn a_package_has_names_that_every_system_can_hold() {
    let folder = folder("portable");
    let force = folder.join("Kanal\\run 12:30.csv");
    fs::rename(force_file(&folder), &force).expect("renamed");
    let mut case = case(&force);
    case.name = "x".repeat(300);
    let zip = folder.join("a.zip");
    let packed = pack(&case, &zip, Existing::Refuse).expect("packed");
    let names: Vec<&str> = packed.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["files/0/Kanal_run 12_30.csv"]);
    let opened = CaseFile::load(&unpack(&zip, &folder.join("there")).expect("unpacked"));
    let opened = opened.expect("loaded");
    assert!(opened.changes().is_empty(), "{:?}", opened.changes());
    assert_eq!(opened.name, case.name);
    // The files of a folder are found by their names, so that they are not changed.
    let logs = folder.join("logs");
    fs::create_dir(&logs).expect("a folder");
    let inner = logs.join("a\\b.csv");
    fs::rename(&force, &inner).expect("renamed");
    let training =
        serde_json::json!({"question": "fine_tune", "data": [], "logs": {"logs": [logs]}});
    let questions = vec![serde_json::from_value(training).expect("a question")];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    let case = CaseFile::new("a", variant);
    let error = pack(&case, &folder.join("b.zip"), Existing::Refuse).expect_err("a backslash");
    assert!(matches!(&error, CaseError::PackedName { path } if *path == inner), "{error}");
    assert!(!folder.join("b.zip").exists());
}

/// A zip of these files, of which each has a name, a mode and a content.
fn zip_of(path: &Path, entries: &[(&str, u32, &[u8])]) {
    let mut zip = zip::ZipWriter::new(fs::File::create(path).expect("a file"));
    for (name, mode, content) in entries {
        let options = zip::write::SimpleFileOptions::default().unix_permissions(*mode);
        zip.start_file(*name, options).expect("an entry");
        std::io::Write::write_all(&mut zip, content).expect("written");
    }
    zip.finish().expect("a zip");
}

#[test]
fn what_is_no_package_is_refused_before_anything_of_it_is_on_disk() {
    let folder = folder("hostile");
    let text = case(Path::new("/nowhere/force.csv")).to_text(&folder.join("c.impactlab"));
    let text = text.expect("text");
    let case: (&str, u32, &[u8]) = ("c.impactlab", 0o644, text.as_bytes());
    let file = |name| (name, 0o644, &b"x"[..]);
    let (package, to) = (folder.join("a.zip"), folder.join("to"));
    for (entries, message) in [
        (vec![case, file("../out.txt")], "\"../out.txt\" is no part of a package"),
        (vec![case, file("files/../../out.txt")], "is no part of a package"),
        (vec![case, file("files/./out.txt")], "is no part of a package"),
        (vec![case, file("/nowhere/out.txt")], "is no part of a package"),
        (vec![case, file("files//nowhere/out.txt")], "is no part of a package"),
        (vec![case, file("..\\out.txt")], "is no part of a package"),
        (vec![case, file("files\\out.txt")], "is no part of a package"),
        (vec![case, file(".bashrc")], "is no part of a package"),
        (vec![case, file("other/out.txt")], "is no part of a package"),
        (vec![("/nowhere/c.impactlab", 0o644, text.as_bytes())], "is no part of a package"),
        (vec![file("files/a")], "it has no case"),
        (vec![case, ("d.impactlab", 0o644, text.as_bytes())], "it has several cases"),
        (vec![case, ("files/0/link", 0o120_777, b"/etc/passwd")], "neither a file nor a folder"),
        (vec![case, ("files/pipe", 0o010_666, b"")], "neither a file nor a folder"),
    ] {
        zip_of(&package, &entries);
        // The writer of the zip sets the kind of a file itself.
        let mut bytes = fs::read(&package).expect("a zip");
        for (name, mode, _) in entries.iter().filter(|(_, mode, _)| mode >> 12 > 0) {
            let at = directory_entry(&bytes, name);
            bytes[at + 40..at + 42].copy_from_slice(&(*mode as u16).to_le_bytes());
        }
        fs::write(&package, bytes).expect("a zip");
        let error = unpack(&package, &to).expect_err(message);
        assert!(
            matches!(&error, CaseError::NoPackage { why, .. } if why.contains(message)),
            "{error}"
        );
        let left = fs::read_dir(&folder).expect("a folder").count();
        assert_eq!(left, 1, "{message}: only the zip is there");
    }
    // A file that says that it is large, and one that is larger than it says.
    for (size, message) in [(300 << 20, "it unpacks to 300 MiB, expected 256 MiB"), (1, "as large")]
    {
        zip_of(&package, &[case, ("files/0/a.csv", 0o644, &[7; 100])]);
        let mut bytes = fs::read(&package).expect("a zip");
        let at = directory_entry(&bytes, "files/0/a.csv");
        bytes[at + 24..at + 28].copy_from_slice(&u32::to_le_bytes(size));
        fs::write(&package, bytes).expect("a zip");
        let error = unpack(&package, &to).expect_err(message).to_string();
        assert!(error.contains(message), "{error}");
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1, "{message}");
    }
}

/// Where the entry of a file begins in the directory of a zip.
fn directory_entry(bytes: &[u8], name: &str) -> usize {
    let is_entry = |at: &usize| {
        bytes[*at..].starts_with(b"PK\x01\x02") && bytes[*at + 46..].starts_with(name.as_bytes())
    };
    (0..bytes.len() - 46).find(is_entry).expect("an entry")
}

#[test]
fn files_of_a_package_that_share_their_bytes_are_refused() {
    let folder = folder("overlap");
    let text = case(Path::new("/nowhere/force.csv")).to_text(&folder.join("c.impactlab"));
    let package = folder.join("a.zip");
    let text = text.expect("text");
    zip_of(
        &package,
        &[
            ("c.impactlab", 0o644, text.as_bytes()),
            ("files/a", 0o644, &[7; 5000]),
            ("files/b", 0o644, &[7; 5000]),
        ],
    );
    let mut bytes = fs::read(&package).expect("a zip");
    let [a, b] = ["files/a", "files/b"].map(|name| directory_entry(&bytes, name) + 42);
    // The entry of the last file leads to the bytes of the one before.
    bytes.copy_within(a..a + 4, b);
    fs::write(&package, bytes).expect("a zip");
    let error = unpack(&package, &folder.join("to")).expect_err("overlapping").to_string();
    assert!(error.contains("share their bytes"), "{error}");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
}

#[test]
fn what_a_killed_unpacking_has_left_is_swept_and_a_living_one_is_not() {
    let folder = folder("swept");
    let case = case(&force_file(&folder));
    pack(&case, &folder.join("a.zip"), Existing::Refuse).expect("packed");
    let [dead, living] = ["dead", "living"].map(|n| folder.join(format!(".impactlab-unpack-{n}")));
    for staging in [&dead, &living] {
        fs::create_dir_all(staging.join("unpacked/files")).expect("a folder");
        fs::write(staging.join(".unpacked.impactlab-lock"), "1").expect("what is left of a lock");
    }
    let _lock = WriterLock::lock_file(&living.join("unpacked")).expect("a lock");
    unpack(&folder.join("a.zip"), &folder.join("to")).expect("unpacked");
    assert!(!dead.exists() && living.exists());
    let hidden = fs::read_dir(&folder).expect("a folder").flatten();
    let hidden = hidden.filter(|entry| entry.file_name().to_string_lossy().starts_with('.'));
    assert_eq!(hidden.count(), 1, "the folder of the living one, with its lock");
}

#[test]
fn a_package_has_the_files_of_questions_and_nothing_else_that_a_case_names() {
    let folder = folder("packed");
    fs::write(folder.join("secret"), "x").expect("written");
    let mut case = case(&force_file(&folder));
    let secret = folder.join("secret");
    let unasked = CheckRequest { paths: vec![secret.clone()], all: false, map: None };
    case.variants[0].unasked = vec![unasked.into()];
    case.variants[0].view = serde_json::json!({"drawn": secret});
    case.variants[0].forms = serde_json::json!({"x": [secret]});
    let files = pack(&case, &folder.join("a.zip"), Existing::Refuse).expect("packed");
    let unpacked = unpack(&folder.join("a.zip"), &folder.join("there")).expect("unpacked");
    let unpacked = CaseFile::load(&unpacked).expect("loaded");
    assert!(matches!(&unpacked.files[..], [file] if file.path.ends_with("force.csv")));
    let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["files/0/force.csv"]);
    assert_eq!(files[0].path, folder.join("force.csv"));
}

/// Paths of files that are not in the package stood in it whole, with the home folder.
#[test]
fn a_package_says_no_folder_of_the_machine_that_packed_it() {
    let folder = folder("packed_paths");
    let gone = folder.join("gone");
    let mut case = case(&force_file(&folder));
    let evidence = EvidenceChoice::File(gone.join("evidence.toml"));
    let checkpoint = Some(gone.join("run.checkpoint"));
    let unasked = ReconstructRequest { checkpoint, ..ReconstructRequest::new(evidence) };
    let variant = &mut case.variants[1];
    variant.unasked = vec![unasked.into()];
    variant.view = serde_json::json!({"file": gone.join("view.csv")});
    variant.forms = serde_json::json!({"x": [gone.join("form.csv")]});
    variant.notes = "/ as seen from the north".to_owned();
    let name = gone.join("own.safetensors").display().to_string();
    case.models.push(UsedModel { network: "force".to_owned(), name, sha256: "ab".to_owned() });
    pack(&case, &folder.join("a.zip"), Existing::Refuse).expect("packed");
    let unpacked = unpack(&folder.join("a.zip"), &folder.join("there")).expect("unpacked");
    let text = fs::read_to_string(unpacked).expect("a case");
    assert!(!text.contains(folder.to_str().expect("Unicode")), "{text}");
    for name in ["evidence.toml", "run.checkpoint", "view.csv", "form.csv", "own.safetensors"] {
        assert!(text.contains(&format!("\"./{name}\"")), "{name}: {text}");
    }
    assert!(text.contains("/ as seen from the north"), "{text}");
}

#[test]
fn a_package_takes_the_curves_of_a_crash_test_along() {
    let folder = folder("curves");
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/ev5/v1.EV5");
    let test = folder.join("v1.EV5");
    fs::copy(kept, &test).expect("copied");
    fs::write(folder.join("v1.001"), "0\t0\n0.001\t-10\n0.002\t0\n").expect("written");
    let check = CheckRequest { paths: vec![test.clone()], all: false, map: None };
    let questions = vec![Request::from(check)];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    let case = CaseFile::new("a", variant);
    assert_eq!(case.used_paths(), [folder.join("v1.001"), test]);
    let zip = folder.join("a.zip");
    let packed = pack(&case, &zip, Existing::Refuse).expect("packed");
    let named = |ending: &str| {
        let found = packed.iter().find(|file| file.name.ends_with(ending)).expect("packed");
        found.name.clone()
    };
    assert_eq!(named("v1.EV5").replace("EV5", "001"), named("v1.001"), "side by side");
    let opened = unpack(&zip, &folder.join("there")).expect("unpacked");
    let there = opened.with_file_name(named("v1.EV5"));
    let force = CrashTest::read(&there).and_then(|test| test.barrier_force());
    assert_eq!(force.expect("a test").expect("a force").time_s, [0.0, 0.001, 0.002]);
}
