//! Films of a scene: the pictures of its instants, in an MP4 file or as numbered PNG files.
//!
//! The encoder is OpenH264 (H.264, constrained baseline, BSD licence), built from its source, in the
//! container MP4. It was chosen by measurement: on one core it encodes 70 to 240 frames of a scene in a
//! second at 1920 × 1080, while rav1e (AV1) at its fastest preset, without assembler, encodes 1 to 4 and
//! makes files of about the same size. Browsers, presentation programs and the players of all systems play it. What
//! it needs more is a C++ compiler while the program is built; assembler is used where `nasm` is there.
//! H.264 is covered by patents in some countries; who sells copies of this program in large numbers has
//! to look at the terms of the patent pool.
//!
//! The quantiser is fixed and the encoder runs on one thread, so that the same film gives the same
//! bytes. A frame is drawn while the one before it is encoded.

mod encoder;
mod frames;
mod make;
mod mp4;
mod strip;

pub use frames::FrameRenderer;
pub use make::{Film, FilmError, write_film, write_frames};
