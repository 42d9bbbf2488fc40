//! What draws the window: the graphics processor if there is one, else the processor.
//!
//! egui's shader for wgpu has a branch that reads four texels for each pixel. A graphics processor
//! leaves it out, but software drivers carry out both branches, which takes nine tenths of a frame. Its
//! shader for OpenGL has no such branch, so that it draws the window where there is no graphics
//! processor (figures in `BENCHMARKS.md`).

use eframe::wgpu::{Backends, DeviceType, Instance, InstanceDescriptor};
use eframe::{NativeOptions, Renderer};

/// What draws the window.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum RendererChoice {
    /// What suits the machine.
    #[default]
    Automatic,
    /// wgpu, which also draws the scenes.
    Wgpu,
    /// OpenGL; the scenes are drawn on the CPU.
    OpenGl,
}

impl RendererChoice {
    fn is_wgpu(self) -> bool {
        match self {
            Self::Automatic => has_graphics_processor() || !has_open_gl(),
            Self::Wgpu => true,
            Self::OpenGl => false,
        }
    }
}

/// The options of the window with a renderer.
pub fn options(choice: RendererChoice) -> NativeOptions {
    if choice.is_wgpu() {
        return NativeOptions { renderer: Renderer::Wgpu, ..NativeOptions::default() };
    }
    // Noise against banding has nothing to do in flat colours.
    NativeOptions { renderer: Renderer::Glow, dithering: false, ..NativeOptions::default() }
}

/// Whether there is an adapter that is not emulated in software.
fn has_graphics_processor() -> bool {
    device_types(Backends::PRIMARY).into_iter().any(|kind| kind != DeviceType::Cpu)
}

/// Whether OpenGL can be used, if only in software.
fn has_open_gl() -> bool {
    !device_types(Backends::GL).is_empty()
}

fn device_types(backends: Backends) -> Vec<DeviceType> {
    let descriptor =
        InstanceDescriptor { backends, ..InstanceDescriptor::new_without_display_handle() };
    let adapters = pollster::block_on(Instance::new(descriptor).enumerate_adapters(backends));
    adapters.into_iter().map(|adapter| adapter.get_info().device_type).collect()
}
