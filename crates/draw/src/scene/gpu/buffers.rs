//! Memory of the graphics processor that grows with what is written into it.

use eframe::wgpu;

use crate::scene::gpu::SceneDevice;

/// A buffer that is at least as large as what was written last.
#[derive(Debug)]
pub struct GrowingBuffer {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
    n: u32,
}

impl GrowingBuffer {
    /// An empty buffer.
    pub fn new(label: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { label, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None, n: 0 }
    }

    /// An empty buffer of vertices or of instances.
    pub fn for_vertices(label: &'static str) -> Self {
        Self::new(label, wgpu::BufferUsages::VERTEX)
    }

    /// Replaces what is in the buffer.
    ///
    /// - returns whether the buffer is another one than before.
    pub fn write<T: bytemuck::NoUninit>(&mut self, on: &SceneDevice, items: &[T]) -> bool {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        self.n = items.len() as u32;
        let needed = (bytes.len() as u64).max(1);
        let is_new = self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed);
        if is_new {
            let size = needed.next_power_of_two().max(256);
            let (label, usage) = (Some(self.label), self.usage);
            let descriptor =
                wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false };
            self.buffer = Some(on.device.create_buffer(&descriptor));
        }
        if let (Some(buffer), false) = (&self.buffer, bytes.is_empty()) {
            on.queue.write_buffer(buffer, 0, bytes);
        }
        is_new
    }

    /// Number of items that were written last.
    pub fn n(&self) -> u32 {
        self.n
    }

    /// The buffer, once something was written.
    pub fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }
}
