//! Encoded frames as an MP4 file.
//!
//! A player begins before the whole file is there, because the table of frames stands before the frames.
//! Its size is known only after the last frame; until then the frames are kept in memory, and in a
//! temporary file without a name if they are many.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::num::NonZeroU32;

use shiguredo_mp4::TrackKind;
use shiguredo_mp4::bitstream::h264::{
    H264NalUnitType, H264SampleEntryConfig, LengthSize, build_avc1_box_from_annexb,
    parse_annexb_nal_units,
};
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::mux::{
    Mp4FileMuxer, Mp4FileMuxerOptions, Sample, estimate_maximum_moov_box_size,
};
use tempfile::SpooledTempFile;

use crate::film::FilmError;
use crate::film::encoder::EncodedFrame;

/// Bytes of frames that are kept in memory.
const IN_MEMORY_BYTES: usize = 64 << 20;

/// An MP4 file that is being made.
pub struct Mp4Film {
    muxer: Mp4FileMuxer,
    head: Vec<u8>,
    frames: SpooledTempFile,
    next_offset: u64,
    frames_per_s: NonZeroU32,
    is_first: bool,
}

impl Mp4Film {
    /// A film without frames.
    ///
    /// - `n_frames`: how many there will be, for which room is left in the table.
    ///
    /// # Errors
    /// [`FilmError::Container`], if the head cannot be made.
    pub fn new(frames_per_s: u32, n_frames: usize) -> Result<Self, FilmError> {
        let reserved_moov_box_size = estimate_maximum_moov_box_size(&[n_frames]);
        let options = Mp4FileMuxerOptions { reserved_moov_box_size, ..Default::default() };
        let muxer = Mp4FileMuxer::with_options(options)?;
        let head = muxer.initial_boxes_bytes().to_vec();
        Ok(Self {
            next_offset: head.len() as u64,
            muxer,
            head,
            frames: SpooledTempFile::new(IN_MEMORY_BYTES),
            frames_per_s: NonZeroU32::new(frames_per_s).unwrap_or(NonZeroU32::MIN),
            is_first: true,
        })
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// [`FilmError::Container`] for a frame that is no H.264, [`FilmError::Temporary`] without room for
    /// the frames.
    pub fn push(&mut self, frame: &EncodedFrame) -> Result<(), FilmError> {
        let sample_entry = match self.is_first {
            false => None,
            true => {
                let config = H264SampleEntryConfig { length_size: LengthSize::FourBytes };
                Some(SampleEntry::Avc1(build_avc1_box_from_annexb(&frame.annex_b, &config)?))
            }
        };
        let data = with_lengths(&frame.annex_b)?;
        self.frames.write_all(&data).map_err(FilmError::Temporary)?;
        self.muxer.append_sample(&Sample {
            track_kind: TrackKind::Video,
            sample_entry,
            keyframe: frame.is_key,
            timescale: self.frames_per_s,
            duration: 1,
            composition_time_offset: None,
            data_offset: self.next_offset,
            data_size: data.len(),
        })?;
        self.next_offset += data.len() as u64;
        self.is_first = false;
        Ok(())
    }

    /// Completes the table of frames.
    ///
    /// # Errors
    /// [`FilmError::Container`] without frames.
    pub fn finish(mut self) -> Result<FinishedMp4, FilmError> {
        let finished = self.muxer.finalize()?;
        let (mut head, mut tail) = (self.head, Vec::new());
        for (offset, bytes) in finished.offset_and_bytes_pairs() {
            let at = usize::try_from(offset).unwrap_or(usize::MAX);
            match head.get_mut(at..at.saturating_add(bytes.len())) {
                Some(place) => place.copy_from_slice(bytes),
                // Only a table for which too little room was left stands behind the frames.
                None => tail.extend_from_slice(bytes),
            }
        }
        self.frames.seek(SeekFrom::Start(0)).map_err(FilmError::Temporary)?;
        Ok(FinishedMp4 { head, frames: self.frames, tail })
    }
}

/// A complete MP4 file that is not written yet.
pub struct FinishedMp4 {
    head: Vec<u8>,
    frames: SpooledTempFile,
    tail: Vec<u8>,
}

impl FinishedMp4 {
    /// Writes the file.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn write(&mut self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.head)?;
        let mut buffer = vec![0; 1 << 16];
        loop {
            let n = self.frames.read(&mut buffer)?;
            if n == 0 {
                break;
            }
            out.write_all(buffer.get(..n).unwrap_or_default())?;
        }
        out.write_all(&self.tail)
    }
}

/// The NAL units of a frame, each behind its length in four bytes; parameter sets are left out, because
/// they stand in the head of the file.
fn with_lengths(annex_b: &[u8]) -> Result<Vec<u8>, FilmError> {
    let mut data = Vec::with_capacity(annex_b.len() + 16);
    for unit in parse_annexb_nal_units(annex_b)? {
        if matches!(unit.nal_unit_type, H264NalUnitType::Sps | H264NalUnitType::Pps) {
            continue;
        }
        let length = u32::try_from(unit.data.len()).unwrap_or(u32::MAX);
        data.extend_from_slice(&length.to_be_bytes());
        data.extend_from_slice(unit.data);
    }
    Ok(data)
}
