//! MDF files of version 4 (`.mf4`) as tables: a part for each group of channels. Their time is the master
//! channel of the group; names and units are those of the channels; conversions that are lines are applied, and
//! samples that are marked as invalid are blank. Texts, structures and other conversions are left out and named.
//! The bytes are read by [`mdf_blocks`](super::mdf_blocks) and [`mdf_records`](super::mdf_records), which
//! describe their layout.

use std::path::Path;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::bytes::some;
use crate::data::formats::mdf_blocks::{MdfGroup, groups, is_unfinished, version};
use crate::data::formats::mdf_records::Records;
use crate::data::formats::{Converted, Said, chosen_part, number_text};
use crate::data::{DataError, ReadSettings, Sheet, read_bytes};

/// Cells that any file may have, and how many more for each of its bytes.
const FREE_CELLS: usize = 500_000;
const CELLS_PER_BYTE: usize = 16;

/// Reads an MDF file as the text of a table.
///
/// # Errors
/// [`DataError::OtherFormat`] of another version, not finished, or without channels of numbers,
/// [`DataError::DamagedAt`] if it does not follow its format, [`DataError::NoSheet`] without such a group.
pub(super) fn as_table(path: &Path, settings: &ReadSettings) -> Result<Converted, DataError> {
    let bytes = read_bytes(path, MAX_TABLE_BYTES)?;
    let other = |format, remedy| DataError::OtherFormat { path: path.to_owned(), format, remedy };
    let Some(version) = version(&bytes) else {
        let remedy = "convert it to MDF 4.1, or export the channels over time as CSV";
        return Err(match is_unfinished(&bytes) {
            true => {
                other("an MDF file that was not finished", "finish it with the logger's program")
            }
            false => other("an MDF file of a version that is not read", remedy),
        });
    };
    let (mut groups, mut left_out) = groups(&bytes).map_err(|fault| fault.in_file(path))?;
    let without = groups.iter().filter(|group| group.channels.is_empty());
    left_out.extend(without.map(|group| format!("{} (no channel of numbers)", group.name)));
    groups.retain(|group| !group.channels.is_empty());
    if groups.is_empty() {
        let remedy = "it has no channel of numbers; export the channels over time as CSV";
        return Err(other("an MDF file", remedy));
    }
    let all: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
    let is_whole = |group: &MdfGroup| group.n_records > 1 && group.channels.len() > 1;
    let first = groups.iter().position(is_whole).unwrap_or(0);
    let at = chosen_part(path, &all, first, settings)?;
    let Some(group) = groups.get(at) else {
        return Err(DataError::Empty { path: path.to_owned() });
    };
    let records = Records::read(&bytes, group).map_err(|fault| fault.in_file(path))?;
    let n_cells = records.len().saturating_mul(group.channels.len());
    let limit = FREE_CELLS.saturating_add(CELLS_PER_BYTE.saturating_mul(bytes.len()));
    let table = if n_cells <= limit { table(group, &records) } else { None };
    let Some((text, invalid)) = table else {
        let (bytes, limit) = (MAX_TABLE_BYTES + 1, MAX_TABLE_BYTES);
        return Err(DataError::TooLarge { path: path.to_owned(), bytes, limit });
    };
    let mut doubts = doubts(group, &records);
    doubts.extend(invalid);
    if !left_out.is_empty() {
        doubts.push(format!("groups are left out: {}", some(&left_out)));
    }
    let description = format!(
        "an MDF file of version {}.{:02}; read is {} with {} channels and {} records",
        version / 100,
        version % 100,
        group.name,
        group.channels.len(),
        records.len()
    );
    let part = Some(Sheet { name: group.name.clone(), all });
    Ok(Converted { text, said: Said { description, doubts, part, ..Said::default() } })
}

/// The text of the table, and what is said of samples that are invalid; `None` beyond the size of one.
fn table(group: &MdfGroup, records: &Records<'_>) -> Option<(String, Option<String>)> {
    let header: Vec<&str> = group.channels.iter().map(|channel| channel.header.as_str()).collect();
    let mut text = header.join("\t") + "\n";
    let mut n_invalid = 0_usize;
    for row in 0..records.len() {
        for (idx, channel) in group.channels.iter().enumerate() {
            if idx > 0 {
                text.push('\t');
            }
            match records.value(row, group, channel) {
                Some(value) => text.push_str(&number_text(value)),
                None => n_invalid += 1,
            }
        }
        text.push('\n');
        if text.len() as u64 > MAX_TABLE_BYTES {
            return None;
        }
    }
    let said = (n_invalid > 0)
        .then(|| format!("{n_invalid} samples are marked as invalid in the file and left blank"));
    Some((text, said))
}

fn doubts(group: &MdfGroup, records: &Records<'_>) -> Vec<String> {
    let mut doubts = Vec::new();
    if !group.channels.iter().any(|channel| channel.is_time) {
        doubts.push("the group has no time as its master channel".to_owned());
    }
    if records.len() as u64 != group.n_records || records.n_bytes_cut > 0 {
        doubts.push(format!(
            "the group says that it has {} records, and {} were found, with {} bytes left over",
            group.n_records,
            records.len(),
            records.n_bytes_cut
        ));
    }
    if !group.left_out.is_empty() {
        doubts.push(format!("channels are left out: {}", some(&group.left_out)));
    }
    doubts
}
