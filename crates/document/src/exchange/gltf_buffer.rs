//! The numbers of a glTF file: one buffer, with a view and an accessor for each list.

use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Buffer, Target, View};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Index, Root, Value};

/// A glTF file that is being made.
#[derive(Default)]
pub struct GltfBuilder {
    /// What the file describes.
    pub root: Root,
    /// Its numbers, little-endian.
    pub bytes: Vec<u8>,
}

impl GltfBuilder {
    /// Adds a list of numbers or of vectors.
    ///
    /// - `target`: what the graphics processor does with them; none for an animation.
    pub fn list<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        target: Option<Target>,
    ) -> Index<Accessor> {
        let byte_offset = self.bytes.len();
        for value in values.iter().flatten() {
            self.bytes.extend_from_slice(&value.to_le_bytes());
        }
        // Every view begins at a multiple of four, as all numbers have four bytes.
        let view = self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(self.bytes.len() - byte_offset),
            byte_offset: Some(USize64::from(byte_offset)),
            byte_stride: None,
            extensions: None,
            extras: Default::default(),
            name: None,
            target: target.map(Checked::Valid),
        });
        let limit = |pick: fn(f32, f32) -> f32| -> Value {
            let all = (0..N).map(|i| values.iter().map(|value| value[i]).reduce(pick));
            Value::from(all.map(Option::unwrap_or_default).collect::<Vec<f32>>())
        };
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(values.len()),
            component_type: Checked::Valid(GenericComponentType(ComponentType::F32)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(match N {
                1 => Type::Scalar,
                2 => Type::Vec2,
                3 => Type::Vec3,
                _ => Type::Vec4,
            }),
            min: Some(limit(f32::min)),
            max: Some(limit(f32::max)),
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    /// Describes the buffer, after the last list.
    pub fn describe_buffer(&mut self) {
        self.root.push(Buffer {
            byte_length: USize64::from(self.bytes.len()),
            extensions: None,
            extras: Default::default(),
            name: None,
            uri: None,
        });
    }
}
