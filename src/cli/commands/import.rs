//! `impactlab import`: what can be used of a file of another program, as files of this one.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::import_ground::{Ground, GroundArgs, import_ground};
use crate::cli::console::{Console, Verdict, shown_path};
use crate::cli::options::{OverwriteArg, SIDES, Values, one_value_of};
use impactlab_core::collision::contact::BarrierTest;
use impactlab_core::collision::{ChannelClass, Role, filter_channel};
use impactlab_core::data::{
    ColumnMap, CrashTest, Existing, RecordedControls, RecordedSide, RecorderRecord, Severity,
    check_file, parts_beside, read_any_series, write_bytes, write_restricted_series_csv,
    write_restricted_table,
};
use impactlab_reconstruct::evidence::{Edr, Evidence};

/// Read a recorder, a crash test, a log or a ground, and write what can be used of it
///
/// Files are known by their content: reports of Bosch CDR tools as CSV, tests of the NHTSA database (.EV5 with
/// its curves), ISO-MME, GPX, NMEA, VBO, Parquet, TDMS, MDF, results of LS-DYNA (rcforc, nodout, rbdout,
/// secforc, binout) and OpenRadioss (T01), and tables; for a ground KML, GeoJSON, points of a total station,
/// LAS, LAZ and E57.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ImportArgs {
    /// The file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The folder for what is written
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Which column is what, as for `check`; of a recorder's report it takes a table instead of the record
    #[arg(long)]
    map: Option<ColumnMap>,
    /// Take a table as that of an event data recorder (49 CFR 563)
    #[arg(long, conflicts_with = "map")]
    recorder: bool,
    /// Which event of a recorder, counted from 1
    #[arg(long, value_name = "N")]
    event: Option<usize>,
    /// In which car the recorder was
    #[arg(long, value_parser = one_value_of(CARS), default_value = "struck")]
    car: Role,
    /// To which side the lateral Δv of the recorder is positive
    #[arg(long, value_parser = one_value_of(SIDES), default_value = "right")]
    lateral: RecordedSide,
    /// To which side its yaw rate is positive
    #[arg(long, value_parser = one_value_of(SIDES), default_value = "right")]
    yaw_rate: RecordedSide,
    /// Evidence that the record is added to; a new file has the record alone
    #[arg(long, value_name = "EVIDENCE.toml")]
    evidence: Option<PathBuf>,
    #[command(flatten)]
    ground: GroundArgs,
    #[command(flatten)]
    overwrite: OverwriteArg,
}

const EXAMPLES: &str = "\
Examples:
  impactlab import report.csv --out record
  impactlab import report.csv --car striking --evidence found.toml --out record
  impactlab import v10146.EV5 --out test
  impactlab import binout0000 --map \"deck=t-mm-s,sheet=contact 3 master\" --out force
  impactlab import log.parquet --map \"x=east_m,y=north_m\" --out log

  impactlab import scan.laz --resolution 0.02 --out ground
  impactlab import points.csv --line TL --out ground

A recorder gives evidence.toml (Δv within 10 %, the speed before the crash within 4 %, or more where it was
recorded earlier than the crash) and controls.csv. A crash test gives barrier_force.csv and crush.toml, a
section of a vehicle file. A ground gives site.toml, with an orthophoto and a picture of heights if it is a
point cloud. Anything else gives series.csv in SI units.

JSON: {kind, files, notes}";

/// The cars in which a recorder may have been.
const CARS: Values<Role> = &[(Role::Struck, ""), (Role::Striking, "")];

/// What was written, and what is to be said of it.
#[derive(Debug, Serialize)]
pub(super) struct Imported {
    pub kind: &'static str,
    pub files: Vec<PathBuf>,
    pub notes: Vec<String>,
}

/// Reads the file, writes the folder and says what is in it.
pub(in crate::cli) fn run(
    args: &ImportArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let ground = Ground::from_path(&args.file).filter(|_| args.map.is_none() && !args.recorder);
    args.ground.check(&args.file, ground.as_ref())?;
    console.expect_folder();
    let mut read: Vec<PathBuf> = [&args.file].into_iter().chain(&args.evidence).cloned().collect();
    read.extend(parts_beside(&args.file));
    console.reads(&read)?;
    let (folder, record) = console.begin_folder(&args.out, args.overwrite.into())?;
    let is_recorder =
        args.recorder || (args.map.is_none() && RecorderRecord::is_report(&args.file));
    let is_test = args.map.is_none() && CrashTest::is_test(&args.file);
    let mut imported = match &ground {
        Some(ground) => import_ground(&args.file, ground, &args.ground, folder.staging())?,
        None if is_recorder => import_recorder(args, folder.staging())?,
        None if is_test => import_test(args, folder.staging())?,
        None => import_series(args, folder.staging())?,
    };
    for file in &mut imported.files {
        *file = folder.path_of(&file.to_string_lossy());
    }
    folder.finish(record)?;
    console.print(&imported, |out| print(out, &imported))?;
    Ok(Verdict::Clean)
}

fn print(out: &mut dyn Write, imported: &Imported) -> io::Result<()> {
    writeln!(out, "{}", imported.kind)?;
    for file in &imported.files {
        writeln!(out, "written: {}", shown_path(file))?;
    }
    for note in &imported.notes {
        writeln!(out, "note: {note}")?;
    }
    Ok(())
}

/// Evidence and controls of a recorder.
fn import_recorder(args: &ImportArgs, staging: &Path) -> Result<Imported, CliError> {
    let mut record = RecorderRecord::read(&args.file, args.event)?;
    if args.lateral == RecordedSide::Left {
        record.turn_lateral();
    }
    if args.yaw_rate == RecordedSide::Left {
        record.turn_yaw_rate();
    }
    let mut evidence = match &args.evidence {
        Some(path) => Evidence::load_draft(path).map_err(impactlab_study::StudyError::from)?,
        None => {
            let name = args.file.file_name().unwrap_or_default();
            Evidence { case: name.to_string_lossy().into_owned(), ..Evidence::default() }
        }
    };
    if evidence.is_single_car() {
        return Err(CliError::RecorderOfSingleCar { name: evidence.case });
    }
    let edr = Edr::from_record(&record);
    let before = match args.car {
        Role::Struck => evidence.edr.replace(edr),
        Role::Striking => evidence.striking_edr.replace(edr),
    };
    let text = evidence.to_toml();
    write_bytes(&staging.join("evidence.toml"), Existing::Refuse, text.as_bytes())?;
    let mut files = vec![PathBuf::from("evidence.toml")];
    let mut notes = vec![record.description.clone()];
    notes.extend(record.doubts.iter().cloned());
    if !record.event.is_empty() {
        notes.push(format!("event {} of {}", record.event, record.events.len()));
    }
    if before.is_some() {
        notes.push("the evidence had a record of this car already; it is replaced".to_owned());
    }
    let lack = evidence.missing();
    notes.extend(lack.map(|lack| format!("the evidence is not complete yet: {lack}")));
    if let Some(speed) = record.speed_before {
        notes.push(format!(
            "the speed before the crash is {:.2} m/s, recorded at {} s; what braking took after that is not in it, \
             and where it was recorded earlier than 0 s its standard deviation is larger by that",
            speed.speed_m_s, speed.at_s
        ));
        if record.before.is_braked_at(speed.at_s) {
            notes.push(
                "the brake was on at that speed: braked wheels turn slower than the car moves, in tests of recorders \
                 under full braking by 8 to 18 %; take the last speed before the brake, or make \
                 speed_before_sigma_m_s so large that it holds that"
                    .to_owned(),
            );
        }
    }
    if let Some(delta_v) = record.delta_v_ahead {
        let became = if delta_v.delta_v_m_s < 0.0 { "slower" } else { "faster" };
        notes.push(format!(
            "by the record the crash made the car {became} by {:.2} m/s along it; if that is the wrong way round, \
             change the sign of delta_v_x in evidence.toml",
            delta_v.delta_v_m_s.abs()
        ));
    }
    let sides = record.sides;
    let side = |stated: Option<RecordedSide>, said| stated.unwrap_or(said).word();
    notes.push(format!(
        "time 0 is when the recorder woke up, some milliseconds after the first contact; the sensor is taken to be \
         at the CG until sensor_x_m and sensor_y_m say where it is; lateral Δv is taken as positive to the {}, the \
         yaw rate as positive to the {}, the angle of the steering wheel as positive to the {}",
        side(sides.lateral, args.lateral),
        side(sides.yaw_rate, args.yaw_rate),
        side(sides.steering, RecordedSide::Left)
    ));
    if !record.before.time_s.is_empty() {
        write_controls(&staging.join("controls.csv"), &record.before)?;
        files.push(PathBuf::from("controls.csv"));
    }
    Ok(Imported { kind: "record of an event data recorder", files, notes })
}

/// Writes what was recorded before the crash; the yaw rate is turned to the left.
fn write_controls(path: &Path, before: &RecordedControls) -> Result<(), CliError> {
    let to_left = |rate: &f64| 0.0 - rate;
    let yaw_rate: Vec<f64> = before.yaw_rate_right_rad_s.iter().map(to_left).collect();
    let switch =
        |on: &[bool]| -> Vec<f64> { on.iter().map(|on| f64::from(u8::from(*on))).collect() };
    let (braked, anti_lock) = (switch(&before.is_braked), switch(&before.is_anti_lock_active));
    let columns = [
        ("time_s", &before.time_s),
        ("speed_m_s", &before.speed_m_s),
        ("steering_wheel_rad", &before.steering_wheel_rad),
        ("yaw_rate_rad_s", &yaw_rate),
        ("service brake on", &braked),
        ("abs activity", &anti_lock),
    ];
    let columns: Vec<_> = columns.into_iter().filter(|(_, values)| !values.is_empty()).collect();
    let header: Vec<String> = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
    let row = |idx: usize| -> Vec<String> {
        let cells = columns.iter().filter_map(move |(_, values)| values.get(idx));
        cells.map(f64::to_string).collect()
    };
    let rows = (0..before.time_s.len()).map(row);
    Ok(write_restricted_table(path, Existing::Refuse, &header, rows, None)?)
}

/// Force and stiffness of a crash test.
fn import_test(args: &ImportArgs, staging: &Path) -> Result<Imported, CliError> {
    let test = CrashTest::read(&args.file)?;
    let mut notes = vec![format!("{}; {} channels", test.title, test.channels.len())];
    let mut files = Vec::new();
    let force = test.barrier_force()?;
    if let Some(force) = &force {
        let header = ["time_s", "fx_body_n", "fy_body_n"].map(str::to_owned);
        let rows = force.time_s.iter().zip(&force.force_n);
        let rows = rows.map(|(t, f)| vec![t.to_string(), f.to_string(), "0".to_owned()]);
        let path = staging.join("barrier_force.csv");
        write_restricted_table(&path, Existing::Refuse, &header, rows, None)?;
        files.push(PathBuf::from("barrier_force.csv"));
        notes.extend(test.barrier_doubts(force));
        if let Some(momentum) = test.momentum(force) {
            notes.push(format!(
                "the barrier took {:.0} N s, {:.3} times the momentum of the vehicle",
                momentum.impulse_n_s,
                momentum.ratio()
            ));
        }
        match filter_channel(ChannelClass::Cfc60, &force.time_s, &force.force_n) {
            Ok(filtered) => notes.push(format!(
                "largest force {:.0} N in CFC 60; the file has the force as recorded",
                filtered.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()))
            )),
            Err(error) => notes.push(format!("the force cannot be filtered: {error}")),
        }
    }
    match crush_section(&test) {
        Ok((section, said)) => {
            write_bytes(&staging.join("crush.toml"), Existing::Refuse, section.as_bytes())?;
            files.push(PathBuf::from("crush.toml"));
            notes.extend(said);
        }
        Err(why) => notes.push(format!("no stiffness follows from this test: {why}")),
    }
    if files.is_empty() {
        notes.push("its channels can be read with a map: see what `check` says of it".to_owned());
    }
    nothing_else(args, Imported { kind: "crash test", files, notes })
}

/// A test of which nothing could be written is an error.
fn nothing_else(args: &ImportArgs, imported: Imported) -> Result<Imported, CliError> {
    match imported.files.is_empty() {
        false => Ok(imported),
        true => Err(CliError::NothingImported {
            path: args.file.clone(),
            why: imported.notes.join("; "),
        }),
    }
}

/// The section of a vehicle file with the stiffness of the front, and what is said of it.
///
/// # Errors
/// What is missing, in words.
fn crush_section(test: &CrashTest) -> Result<(String, Vec<String>), String> {
    let test = BarrierTest::from_crash_test(test)?;
    let found = test.stiffness().map_err(|error| error.to_string())?;
    let mean_m = test.mean_crush_m();
    let one_n_per_m2 = test.single_stiffness_n_per_m2();
    let section = format!(
        "[crush.front]\nonset_n_per_m = {:.0}\nstiffness_n_per_m2 = {:.0}\n",
        found.onset_n_per_m, found.stiffness_n_per_m2
    );
    let said = format!(
        "A = {:.0} N/m, B = {:.0} N/m², Kv = {one_n_per_m2:.0} N/m² over the width of the car and a mean crush of \
         {mean_m:.3} m; nothing is crushed up to 5 mph, which is assumed; the crush is taken as that of the front",
        found.onset_n_per_m, found.stiffness_n_per_m2
    );
    Ok((section, vec![said]))
}

/// Any other file as a table in SI units.
fn import_series(args: &ImportArgs, staging: &Path) -> Result<Imported, CliError> {
    let loaded = read_any_series(&args.file, args.map.as_ref())?;
    loaded.check_consistent(&args.file)?;
    let doubts = loaded.notes.iter().filter(|note| note.is_doubt()).map(ToString::to_string);
    // What `check` says of the numbers is said of those that are written, too.
    let flags = check_file(&loaded);
    let flags = flags.iter().filter(|flag| flag.severity >= Severity::Warning);
    let flags: Vec<String> = flags.map(ToString::to_string).collect();
    let doubts: Vec<String> = doubts.chain(flags.iter().cloned()).collect();
    let restrictions = (!doubts.is_empty()).then(|| doubts.join("; "));
    write_restricted_series_csv(
        &staging.join("series.csv"),
        Existing::Refuse,
        &loaded.series,
        restrictions.as_deref(),
    )?;
    let notes = loaded.notes.iter().map(ToString::to_string).chain(flags).collect();
    Ok(Imported { kind: "time series", files: vec![PathBuf::from("series.csv")], notes })
}
