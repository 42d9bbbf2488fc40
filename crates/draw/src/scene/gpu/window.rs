//! Scenes on the graphics device of a window, where they are shown without leaving its memory.

use std::sync::Arc;

use eframe::egui_wgpu::{RenderState, Renderer};
use eframe::wgpu;
use egui::TextureId;
use egui::mutex::RwLock;

use crate::gpu::GpuError;
use crate::scene::SceneLook;
use crate::scene::gpu::{GpuCanvas, SceneDevice};
use impactlab_document::scene::Scene;

/// The graphics device of a window.
#[derive(Clone)]
pub struct WindowDevice {
    device: Arc<SceneDevice>,
    renderer: Arc<RwLock<Renderer>>,
}

impl WindowDevice {
    /// Prepares the device of a window.
    ///
    /// # Errors
    /// Those of [`SceneDevice::new`].
    pub fn new(window: &RenderState) -> Result<Self, GpuError> {
        let device = SceneDevice::new(window.device.clone(), window.queue.clone())?;
        Ok(Self { device: Arc::new(device), renderer: Arc::clone(&window.renderer) })
    }
}

/// A scene in a window.
pub struct WindowCanvas {
    on: WindowDevice,
    canvas: GpuCanvas,
    /// By what the window knows the picture, and its size.
    shown: Option<(TextureId, [usize; 2])>,
}

impl WindowCanvas {
    /// A canvas in a window.
    pub fn new(on: WindowDevice) -> Self {
        Self { canvas: GpuCanvas::new(Arc::clone(&on.device)), shown: None, on }
    }

    /// Draws a scene at a time, if that is not the last picture already.
    ///
    /// # Errors
    /// Those of [`GpuCanvas::draw`]. The canvas is not to be used after that.
    pub fn draw(
        &mut self,
        scene: &Arc<Scene>,
        look: &SceneLook,
        time_s: f64,
    ) -> Result<Option<TextureId>, GpuError> {
        self.canvas.draw(scene, look, time_s)?;
        let Some(view) = self.canvas.view() else { return Ok(None) };
        let (device, filter) = (self.on.device.device(), wgpu::FilterMode::Nearest);
        let id = match self.shown {
            Some((id, size)) if size == look.size_px => id,
            Some((id, _)) => {
                let mut renderer = self.on.renderer.write();
                renderer.update_egui_texture_from_wgpu_texture(device, view, filter, id);
                id
            }
            None => self.on.renderer.write().register_native_texture(device, view, filter),
        };
        self.shown = Some((id, look.size_px));
        Ok(Some(id))
    }
}

impl Drop for WindowCanvas {
    fn drop(&mut self) {
        if let Some((id, _)) = self.shown {
            self.on.renderer.write().free_texture(&id);
        }
    }
}
