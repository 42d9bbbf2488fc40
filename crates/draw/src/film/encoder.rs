//! Frames as H.264.

use egui::ColorImage;
use openh264::OpenH264API;
use openh264::encoder::{
    Complexity, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, MatrixCoefficients, QpRange,
    RateControlMode, UsageType, VuiConfig,
};
use openh264::formats::{RgbaSliceU8, YUVBuffer};

use crate::film::FilmError;

/// Quantiser of every frame: edges of text stay sharp.
const QUANTISER: u8 = 22;

/// An encoder of frames of one size.
pub struct FrameEncoder {
    encoder: Encoder,
    frame: YUVBuffer,
}

/// An encoded frame.
pub struct EncodedFrame {
    /// NAL units, each behind a start code (ITU-T H.264, annex B).
    pub annex_b: Vec<u8>,
    /// Whether it is decoded without another one.
    pub is_key: bool,
}

impl FrameEncoder {
    /// An encoder with a key frame every second, to which a player can jump.
    ///
    /// - `size_px`: width and height, pixels, both even.
    ///
    /// # Errors
    /// [`FilmError::Encoder`], if the encoder does not start.
    pub fn new([width, height]: [usize; 2], frames_per_s: u32) -> Result<Self, FilmError> {
        // The crate converts colours by the matrix of BT.601 into the video range.
        let colors = VuiConfig::bt709().matrix_coefficients(MatrixCoefficients::Smpte170M);
        let config = EncoderConfig::new()
            .max_frame_rate(FrameRate::from_hz(frames_per_s as f32))
            .intra_frame_period(IntraFramePeriod::from_num_frames(frames_per_s))
            .usage_type(UsageType::CameraVideoRealTime)
            .complexity(Complexity::Medium)
            // Does not leave frames out, and has one quantiser where both limits are the same.
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(QUANTISER, QUANTISER))
            .skip_frames(false)
            .scene_change_detect(false)
            .adaptive_quantization(false)
            .background_detection(false)
            .num_threads(1)
            .vui(colors);
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config)?;
        Ok(Self { encoder, frame: YUVBuffer::new(width, height) })
    }

    /// Encodes the next frame.
    ///
    /// # Errors
    /// [`FilmError::Encoder`] with the encoder's words, and for a frame that it leaves out.
    pub fn encode(&mut self, image: &ColorImage) -> Result<EncodedFrame, FilmError> {
        let [width, height] = image.size;
        self.frame.read_rgba8(RgbaSliceU8::new(image.as_raw(), (width, height)));
        let stream = self.encoder.encode(&self.frame)?;
        let annex_b = stream.to_vec();
        let is_key = matches!(
            stream.frame_type(),
            openh264::encoder::FrameType::IDR | openh264::encoder::FrameType::I
        );
        match annex_b.is_empty() {
            true => Err(FilmError::FrameLeftOut),
            false => Ok(EncodedFrame { annex_b, is_key }),
        }
    }
}
