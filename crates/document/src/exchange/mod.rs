//! Scenes and motions for other programs: DXF for drawings, KML and GeoJSON for maps, glTF for 3D programs
//! and browsers, tables for HVE. Everything is written in metres and seconds but the tables for HVE, whose units are those of the
//! United States.

mod dxf_drawing;
mod gltf_buffer;
mod gltf_cars;
mod gltf_file;
mod gltf_frame;
mod gltf_lines;
mod hve;
mod looks;
mod maps;

pub use dxf_drawing::{DxfOptions, dxf};
pub use gltf_file::glb;
pub use gltf_frame::GltfFrame;
pub use hve::{hve_motion, hve_pulse};
pub use maps::map;

/// The reason why something is not written for another program.
#[derive(Debug, thiserror::Error)]
pub enum ExchangeError {
    /// The drawing cannot be written.
    #[error("the drawing cannot be written as DXF")]
    Dxf(#[from] dxf::DxfError),
    /// The scene cannot be written.
    #[error("the scene cannot be written as glTF")]
    Gltf(#[from] gltf::Error),
    /// The description of the scene cannot be written.
    #[error("the scene cannot be written as glTF")]
    Json(#[from] serde_json::Error),
    /// The scene is larger than a file of the format can be.
    #[error(
        "the scene takes {bytes} bytes as glTF, expected at most 4294967295; fewer ghosts or a shorter motion help"
    )]
    TooLarge {
        /// Size of the numbers.
        bytes: usize,
    },
    /// The operating system reports an error.
    #[error("the table cannot be written")]
    Io(#[from] std::io::Error),
    /// Nothing is known of what was asked for.
    #[error("{name}: nothing is known of the {what}")]
    Unknown {
        /// The case or file.
        name: String,
        /// What was asked for.
        what: &'static str,
    },
}
