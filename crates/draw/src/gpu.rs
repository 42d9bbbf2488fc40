//! The graphics processor: how it is found, how its errors are told, how its memory is read.

use std::sync::mpsc;

use eframe::wgpu;

/// Reason for which the graphics processor cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No graphics driver was found.
    #[error(
        "no graphics driver is there; install one, as root on Debian or Ubuntu: \
         apt-get install --no-install-recommends mesa-vulkan-drivers libvulkan1"
    )]
    NoAdapter(#[source] wgpu::RequestAdapterError),
    /// The graphics driver does not provide a device.
    #[error("the graphics driver gives no device")]
    NoDevice(#[from] wgpu::RequestDeviceError),
    /// The work exceeds a limit of the device.
    #[error("{what} is {got}, the graphics device takes {most}")]
    Limit {
        /// Quantity that exceeds the limit.
        what: &'static str,
        /// Value of the quantity.
        got: u64,
        /// Largest permitted value.
        most: u64,
    },
    /// The device rejected a command.
    #[error("the graphics device refuses a command")]
    Device(#[from] wgpu::Error),
    /// Values could not be read from the device.
    #[error("the graphics device returns no values")]
    NoValues(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// A new device, without a window, with all that its adapter permits.
///
/// # Errors
/// [`GpuError::NoAdapter`] and [`GpuError::NoDevice`].
pub(super) fn headless_device() -> Result<(wgpu::Device, wgpu::Queue), GpuError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..wgpu::RequestAdapterOptions::default()
    });
    let adapter = pollster::block_on(adapter).map_err(GpuError::NoAdapter)?;
    let device = adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("impactlab"),
        required_limits: adapter.limits(),
        ..wgpu::DeviceDescriptor::default()
    });
    Ok(pollster::block_on(device)?)
}

/// # Errors
/// [`GpuError::Limit`] for more than `most`.
pub(super) fn check_limit(what: &'static str, got: u64, most: u64) -> Result<(), GpuError> {
    if got > most { Err(GpuError::Limit { what, got, most }) } else { Ok(()) }
}

/// Runs commands and turns an error that the device reports for them into a result.
///
/// # Errors
/// [`GpuError::Device`] for an internal or a validation error or if memory is exhausted.
pub(super) fn checked<T>(
    device: &wgpu::Device,
    commands: impl FnOnce() -> T,
) -> Result<T, GpuError> {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let scopes = [Internal, OutOfMemory, Validation].map(|filter| device.push_error_scope(filter));
    let done = commands();
    // The error scopes are closed in the reverse order of opening.
    let errors: Vec<_> =
        scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).collect();
    errors.into_iter().next().map_or(Ok(done), |error| Err(error.into()))
}

/// Waits for the commands that were submitted, and reads the start of a buffer.
///
/// - `bytes`: how much of it is read;
/// - `read`: what is made of the bytes.
///
/// # Errors
/// [`GpuError::NoValues`], for example if the device was lost.
pub(super) fn read_buffer<T>(
    device: &wgpu::Device,
    buffer: &wgpu::Buffer,
    bytes: u64,
    read: impl FnOnce(&[u8]) -> T,
) -> Result<T, GpuError> {
    let (sender, receiver) = mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, 0..bytes, move |outcome| {
        // The receiver no longer exists if polling has failed below.
        let _ = sender.send(outcome);
    });
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(no_values)?;
    receiver.recv().map_err(no_values)?.map_err(no_values)?;
    let view = buffer.get_mapped_range(0..bytes).map_err(no_values)?;
    let values = read(&view);
    drop(view);
    buffer.unmap();
    Ok(values)
}

fn no_values(source: impl std::error::Error + Send + Sync + 'static) -> GpuError {
    GpuError::NoValues(Box::new(source))
}
