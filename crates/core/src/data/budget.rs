//! The largest sizes that are read. Each is far above what a measurement, a simulation or a person
//! writes, and low enough that reading a file takes a few seconds and a small multiple of its size
//! in memory at most.

/// Bytes of a table: a force, a motion, a steer angle.
pub const MAX_TABLE_BYTES: u64 = 256 << 20;

/// Bytes of a part of a finite-element result file, of which only what is needed is held.
pub const MAX_BINOUT_BYTES: u64 = 8 << 30;

/// Bytes of an Excel workbook. What is in it may have the size of a table when it is unpacked.
pub const MAX_WORKBOOK_BYTES: u64 = 64 << 20;

/// Rows of a sheet of a workbook, as many as Excel has.
pub const MAX_SHEET_ROWS: u32 = 1 << 20;

/// Texts of the cells of a workbook that it says it has.
pub const MAX_WORKBOOK_TEXTS: u64 = 2_000_000;

/// XML elements in which a workbook has its texts, and its styles. A style takes some 300 bytes.
pub const MAX_TEXT_ELEMENTS: u64 = 16_000_000;
pub const MAX_STYLE_ELEMENTS: u64 = 500_000;

/// Bytes of a table of cases, `cases.csv`.
pub const MAX_CASES_BYTES: u64 = 16 << 20;

/// Bytes of the files of all cases that are loaded together.
pub const MAX_DATASET_BYTES: u64 = 1 << 30;

/// Bytes of a line of a table.
pub const MAX_LINE_BYTES: usize = 256 << 10;

/// Columns of a table.
pub const MAX_COLUMNS: usize = 4096;

/// Bytes of a cell of a table.
pub const MAX_CELL_BYTES: usize = 4096;

/// Cases of a data set, and entries of a folder.
pub const MAX_CASES: usize = 100_000;

/// Cells of a table of cases: its rows times its columns.
pub const MAX_CASE_CELLS: usize = 4_000_000;

/// Bytes of a file that a person writes: settings, vehicle, scenario, question.
pub const MAX_SETTINGS_BYTES: u64 = 1 << 20;

/// Bytes of a file of results that the program wrote itself, such as `comparison.json`.
pub const MAX_RESULTS_BYTES: u64 = 64 << 20;

/// Bytes of a model or a checkpoint. The networks here have a few megabytes.
pub const MAX_MODEL_BYTES: u64 = 256 << 20;

/// Bytes of an orthophoto.
pub const MAX_PICTURE_BYTES: u64 = 1 << 30;

/// Pixels of an orthophoto. One takes 12 bytes of memory at the most while the picture is decoded, and some
/// 5 bytes after that.
pub const MAX_PICTURE_PIXELS: u64 = 64 << 20;

/// Pixels of a side of an orthophoto.
pub const MAX_PICTURE_SIDE: u32 = 65_535;

/// Bytes of a drawing.
pub const MAX_DRAWING_BYTES: u64 = 64 << 20;

/// Objects of a drawing, each of which takes some 2 kB of memory while it is read. Drawing programs write
/// 200 bytes for one, so that no file of theirs below [`MAX_DRAWING_BYTES`] has as many.
pub const MAX_DRAWING_OBJECTS: usize = 400_000;

/// Points of the lines of a drawing.
pub const MAX_DRAWING_POINTS: usize = 2_000_000;

/// Bytes of a file of surveyed lines and points: KML, GeoJSON, a table of points.
pub const MAX_SURVEY_BYTES: u64 = 32 << 20;

/// Bytes of a point cloud, of which never more than a few points are in memory.
pub const MAX_CLOUD_BYTES: u64 = 64 << 30;

/// Pixels of the raster that a point cloud becomes. One takes 20 bytes of memory while points are read.
pub const MAX_RASTER_PIXELS: u64 = 16 << 20;
