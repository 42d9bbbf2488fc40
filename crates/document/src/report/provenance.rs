//! Where the answers come from: versions, seeds, files and networks by their content, changes, log.

use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartProvenance;
use crate::report::paths::ShownPaths;
use crate::report::{Block, Language, Table};
use impactlab_study::case_file::{CaseFile, CaseOnDisk, CaseReport, Change, UsedFile, UsedModel};

/// What has changed since the case was saved, as one notice; none if nothing has.
pub(super) fn change_notice(
    changes: &[Change],
    wording: &Wording,
    paths: &ShownPaths,
) -> Option<Block> {
    let words = wording.words;
    let text = |change: &Change| match change {
        Change::Missing { path, .. } => fill(words.change_missing, &[("path", &paths.name(path))]),
        Change::Changed { path } => fill(words.change_changed, &[("path", &paths.name(path))]),
        Change::Case { path } => fill(words.change_case, &[("path", &paths.name(path))]),
        Change::Model { network, name } => {
            let network = network_name(network, wording);
            let name = wording.name(&paths.shown(name));
            fill(words.change_model, &[("network", &network), ("name", &name)])
        }
    };
    let what: Vec<String> = changes.iter().map(text).collect();
    let notice = || Block::notice(fill(words.changed_notice, &[("what", &what.join("; "))]));
    (!what.is_empty()).then(notice)
}

/// Versions, seeds, files and networks.
///
/// - `answers`: each answer by its name, with its provenance.
pub(super) fn provenance_blocks(
    (case, on_disk): (&CaseFile, Option<&CaseOnDisk>),
    report: &CaseReport,
    answers: &[(String, PartProvenance)],
    wording: &Wording,
    paths: &ShownPaths,
) -> Vec<Block> {
    let words = wording.words;
    let versions = [("version", case.program()), ("now", impactlab_core::program::version())];
    // Evidence by itself was never saved as a case.
    let is_saved = !(case.log.is_empty() && case.files.is_empty() && case.models.is_empty());
    let saved = is_saved.then(|| Block::paragraph(fill(words.case_saved_by, &versions)));
    let mut blocks: Vec<Block> = saved.into_iter().collect();
    blocks.extend(is_saved.then(|| Block::paragraph(own_file(on_disk, wording, paths))));
    blocks.extend(change_notice(&report.changes, wording, paths));
    let row = |(name, provenance): &(String, PartProvenance)| {
        let seeds = match provenance.seeds.is_empty() {
            true => words.no_draws.to_owned(),
            false => provenance.seeds.join(", "),
        };
        [name.clone(), provenance.version.clone(), seeds]
    };
    let rows = answers.iter().map(row).collect();
    let columns = [words.answer, words.version, words.seeds];
    blocks.push(Block::Table(Table::new(words.provenance_caption, columns, rows)));
    blocks.push(files(case, wording, paths));
    blocks.push(models(report, wording, paths));
    blocks.push(Block::paragraph(words.reproduce_text));
    blocks
}

/// The file of the case itself, by its content.
pub(super) fn own_file(
    on_disk: Option<&CaseOnDisk>,
    wording: &Wording,
    paths: &ShownPaths,
) -> String {
    let words = wording.words;
    let Some(CaseOnDisk { file, is_as_saved }) = on_disk else {
        return words.case_in_no_file.to_owned();
    };
    let state = match is_as_saved {
        Some(true) => words.case_as_saved,
        Some(false) => words.case_edited,
        None => words.case_without_seal,
    };
    let bytes = file.bytes.to_string();
    let values = [
        ("path", &*paths.name(&file.path)),
        ("bytes", &bytes),
        ("sha256", &file.sha256),
        ("state", state),
    ];
    fill(words.case_file, &values)
}

/// The files as they are now, also those that were not there when the case was saved.
fn files(case: &CaseFile, wording: &Wording, paths: &ShownPaths) -> Block {
    let words = wording.words;
    let saved = |path: &std::path::Path| case.files.iter().find(|file| file.path == *path);
    let mut all = case.used_paths();
    all.extend(case.files.iter().map(|file| file.path.clone()));
    // By name: the folders of a package are others than those of the case.
    all.sort_by_key(|path| (paths.name(path), path.clone()));
    all.dedup();
    let rows: Vec<_> = all
        .iter()
        .map(|path| {
            let name = paths.name(path);
            match (UsedFile::read(path).ok(), saved(path)) {
                (Some(now), before) => {
                    let state = match before {
                        Some(before) if *before == now => words.unchanged,
                        Some(_) => words.changed,
                        None => words.new_file,
                    };
                    [name, now.bytes.to_string(), now.sha256, state.to_owned()]
                }
                (None, before) => {
                    let sha256 = before.map_or_else(String::new, |file| file.sha256.clone());
                    [name, String::new(), sha256, words.missing.to_owned()]
                }
            }
        })
        .collect();
    if rows.is_empty() {
        return Block::paragraph(words.no_files);
    }
    let columns = [words.file, words.bytes, words.sha256, words.state];
    Block::Table(Table::new(words.files_caption, columns, rows).numeric(&[1]))
}

fn models(report: &CaseReport, wording: &Wording, paths: &ShownPaths) -> Block {
    let words = wording.words;
    let models = report.models();
    let row = |model: &UsedModel| {
        let name = wording.name(&paths.shown(&model.name));
        [network_name(&model.network, wording), name, model.sha256.clone()]
    };
    let rows: Vec<_> = models.iter().map(row).collect();
    if rows.is_empty() {
        return Block::paragraph(words.no_models);
    }
    let columns = [words.network, words.name, words.sha256];
    Block::Table(Table::new(words.models_caption, columns, rows))
}

/// What a network of a case is called.
pub(super) fn network_name(network: &str, wording: &Wording) -> String {
    match network {
        "force" => wording.words.force_network.to_owned(),
        "response" => wording.words.response_network.to_owned(),
        other => wording.key(other),
    }
}

/// An entry of the log. Names of variants stay as they are, also where they are words of the program; those that
/// the program gave are as elsewhere in the report.
fn event_text(event: &str, wording: &Wording) -> String {
    if wording.language == Language::En {
        return event.to_owned();
    }
    let pieces: Vec<&str> = event.split('"').collect();
    let named = |name| wording.given_name(name);
    match pieces[..] {
        ["variant ", name, " copied from ", of, ""] => {
            format!("Variante „{}“ aus „{}“ kopiert", named(name), named(of))
        }
        ["variant ", before, " renamed to ", name, ""] => {
            format!("Variante „{}“ in „{}“ umbenannt", named(before), named(name))
        }
        ["variant ", name, " removed"] => format!("Variante „{}“ entfernt", named(name)),
        ["saved"] => "gespeichert".to_owned(),
        ["opened"] => "geöffnet".to_owned(),
        ["opened; edited since it was saved"] => {
            "geöffnet; seit dem Speichern bearbeitet".to_owned()
        }
        ["packed; edited since it was saved"] => {
            "gepackt; seit dem Speichern bearbeitet".to_owned()
        }
        _ => match event.strip_prefix("packed into ") {
            Some(path) => format!("gepackt in {path}"),
            None => wording.quoted(event),
        },
    }
}

/// What was done and when.
pub(super) fn log_blocks(case: &CaseFile, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    if case.log.is_empty() {
        return vec![Block::paragraph(words.no_log)];
    }
    let rows = case
        .log
        .iter()
        .map(|entry| [wording.moment(&entry.time), event_text(&entry.event, wording)]);
    let table = Table::new(words.log_caption, [words.time, words.event], rows.collect());
    vec![Block::Table(table)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Paper, ReportDate, ReportSettings};
    use impactlab_core::units::UnitSystem;

    /// The log of a German report was English.
    #[test]
    fn the_log_is_in_the_language_of_the_report_and_names_stay() {
        let settings = |language| ReportSettings {
            language,
            units: UnitSystem::Si,
            paper: Paper::A4,
            date: ReportDate::new(2026, 1, 2).unwrap(),
        };
        let german = Wording::new(&settings(Language::De));
        for (event, told) in [
            (r#"variant "left" renamed to "mass""#, "Variante „left“ in „mass“ umbenannt"),
            (r#"variant "b" copied from "a""#, "Variante „b“ aus „a“ kopiert"),
            (r#"variant "b" removed"#, "Variante „b“ entfernt"),
            (r#"variant "base 2" removed"#, "Variante „Grundfall 2“ entfernt"),
            ("packed into case.zip", "gepackt in case.zip"),
            ("saved", "gespeichert"),
            (r#"variant "a \"b\"" removed"#, r#"„variant "a \"b\"" removed“"#),
        ] {
            assert_eq!(event_text(event, &german), told);
        }
        assert_eq!(german.moment("2026-11-28T13:03:46Z"), "28.11.2026 13:03:46");
        let english = Wording::new(&settings(Language::En));
        assert_eq!(event_text("saved", &english), "saved");
        assert_eq!(english.moment("2026-11-28T13:03:46Z"), "2026-11-28 13:03:46");
        assert_eq!(english.moment("noon"), "noon");
        let network = |wording| ["force", "response"].map(|name| network_name(name, wording));
        assert_eq!(network(&german), ["Kraftnetz", "Bewegungsnetz"]);
        assert_eq!(network(&english), ["force network", "response network"]);
    }
}
