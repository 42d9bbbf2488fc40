//! Tests of the app, which is driven without a display and drawn on the CPU.

mod arrangement;
mod both_faces;
mod case;
mod caveats;
mod conditioning;
mod density_gpu;
mod film;
mod force_network;
mod ground;
mod harness;
mod import;
mod import_corrections;
mod looks;
mod models;
mod network_figures;
mod pictures;
mod reconstruct;
mod report;
mod response_network;
mod scene;
mod scene_gpu;
mod settings;
mod snapshots;
mod stored;
mod vehicle_form;
mod workflow;
