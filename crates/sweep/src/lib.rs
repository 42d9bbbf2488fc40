//! One question many times: plans, chunks of rows as files, and the atlas that is made of them.
//!
//! ```text
//! plan ──> points ──> rows ──> chunks ──> merged table ──> atlas
//!          (plan, seed, i)     (one file each, in any order, on any machine)
//! ```
//!
//! - `plan`, `plan_file`, `vary`: what is asked, what varies, as a person writes it and as it is resolved;
//! - `points`: the inputs of row i;
//! - `pit`, `outcome`, `row`: the answer of a row;
//! - `rows`, `chunk`: rows as a table and as a file;
//! - `run`, `status`, `merge`, `script`: what is done with a folder of chunks;
//! - `atlas`: cells that are aggregated from rows.

pub mod atlas;

mod chunk;
mod error;
mod merge;
mod outcome;
mod pit;
mod plan;
mod plan_file;
mod plan_paths;
mod points;
mod row;
mod rows;
mod run;
mod script;
mod status;
mod vary;

pub use chunk::{chunk_path, read_chunk, read_rows, rows_bytes};
pub use error::SweepError;
pub use merge::{MergeReport, merge};
pub use outcome::{Outcome, outcomes};
pub use pit::PitInput;
pub use plan::{
    Design, MOST_CHUNK_ROWS, MOST_CHUNKS, MOST_ROWS, PLAN_FILE, PickedOutcome, PitQuestion, Plan,
    RequestQuestion, RowInputs, SweptQuestion, UNKNOWNS, VehiclePairIds,
};
pub use row::{Answerer, Row};
pub use rows::{Column, Rows, RowsMeta};
pub use run::{RunReport, answer_rows, chunks_of_task, run_chunk, run_chunks};
pub use script::{MOST_TASKS, n_tasks, slurm_script};
pub use status::{SweepStatus, array_expression, parse_array};
pub use vary::{Distribution, InputValue, Vary};
