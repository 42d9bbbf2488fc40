//! What is shown, written and signed, as plain data that knows neither pixels nor windows.
//!
//! - [`figure`], [`scene`]: the content of a plot, and of a scene in space;
//! - [`report`]: what an expert signs: a document of a case and its answers, as PDF, Markdown and
//!   JSON;
//! - [`exchange`]: scenes and motions for other programs.

pub mod exchange;
pub mod figure;
pub mod report;
pub mod scene;
