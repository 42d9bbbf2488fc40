//! How the graphics processor draws each kind of thing in a scene.

use std::borrow::Cow;

use eframe::wgpu;
use wgpu::{
    BindingType, BlendFactor, CompareFunction, ShaderStages, TextureSampleType, vertex_attr_array,
};

use crate::gpu::{GpuError, checked};

/// Format of pictures: colours as they are, blended as on the CPU.
pub const COLORS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Format of depths.
pub const DEPTHS: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bytes of an instance of a surface: bounds, corners, colour.
const AREA_BYTES: u64 = 36;
/// Bytes of a stroke: ends, half width and opacity, colour.
const STROKE_BYTES: u64 = 28;
/// Bytes of a shadow: bounds, pose, half sides.
const SHADOW_BYTES: u64 = 40;
/// Bytes of a corner of a mesh: place, normal, surface.
const VERTEX_BYTES: u64 = 28;
/// Bytes of a mesh at its place: three rows to the axes of the camera, sun, paint, depth.
const PART_BYTES: u64 = 88;

/// One pipeline for each kind of thing.
#[derive(Debug)]
pub struct Pipelines {
    /// The picture of the ground.
    pub picture: wgpu::RenderPipeline,
    /// Surfaces on the ground.
    pub areas: wgpu::RenderPipeline,
    /// Grid, density, haze and sky.
    pub cover: wgpu::RenderPipeline,
    /// Lines.
    pub strokes: wgpu::RenderPipeline,
    /// Shadows.
    pub shadows: wgpu::RenderPipeline,
    /// The picture behind the samples.
    pub behind: wgpu::RenderPipeline,
    /// Opaque cars.
    pub opaque: wgpu::RenderPipeline,
    /// The front of a ghost, as depths.
    pub ghost_front: wgpu::RenderPipeline,
    /// The colour of that front.
    pub ghost_color: wgpu::RenderPipeline,
    /// Samples to pixels.
    pub means: wgpu::RenderPipeline,
    scene_layout: wgpu::BindGroupLayout,
    ground_layout: wgpu::BindGroupLayout,
    image_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl Pipelines {
    /// Prepares a device.
    ///
    /// # Errors
    /// [`GpuError::Device`] if it rejects a shader.
    pub fn new(device: &wgpu::Device) -> Result<Self, GpuError> {
        checked(device, || Self::create(device))
    }

    fn create(device: &wgpu::Device) -> Self {
        let [scene_layout, ground_layout, image_layout] = layouts(device);
        let module = |label, source: &'static str| {
            let common = include_str!("common.wgsl");
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(Cow::Owned(format!("{common}\n{source}"))),
            })
        };
        let ground_module = module("ground", include_str!("ground.wgsl"));
        let line_module = module("lines", include_str!("lines.wgsl"));
        let car_module = module("cars", include_str!("cars.wgsl"));
        let with_ground = [Some(&scene_layout), Some(&ground_layout)];
        let on_ground = Maker { device, module: &ground_module, groups: &with_ground };
        let lines = Maker { device, module: &line_module, groups: &with_ground[..1] };
        let with_image = [Some(&scene_layout), Some(&image_layout)];
        let cars = Maker { device, module: &car_module, groups: &with_image };
        let car_buffers = [car_layout(), part_layout()];
        let car = |fragment, depth, target| {
            cars.make("car_corner", fragment, &car_buffers, Stage { depth: Some(depth), ..target })
        };
        let strip = Stage { is_strip: true, ..Stage::OVER };
        Self {
            picture: on_ground.make("whole", "picture_pixel", &[], Stage::OVER),
            areas: on_ground.make("area_corner", "area_pixel", &[area_layout()], strip),
            cover: on_ground.make("whole", "cover_pixel", &[], Stage::PREMULTIPLIED),
            strokes: lines.make("stroke_corner", "stroke_pixel", &[stroke_layout()], strip),
            shadows: lines.make("shadow_corner", "shadow_pixel", &[shadow_layout()], strip),
            behind: cars.make(
                "whole",
                "behind_sample",
                &[],
                Stage { depth: Some((CompareFunction::Always, false)), ..Stage::REPLACE },
            ),
            opaque: car("car_pixel", (CompareFunction::Greater, true), Stage::REPLACE),
            ghost_front: car("car_pixel", (CompareFunction::Greater, true), Stage::NOTHING),
            ghost_color: car("car_pixel", (CompareFunction::Equal, false), Stage::OVER),
            means: cars.make("whole", "mean_of_samples", &[], Stage::REPLACE),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            }),
            scene_layout,
            ground_layout,
            image_layout,
        }
    }

    /// Binds the numbers of a scene.
    pub fn scene_group(&self, device: &wgpu::Device, scene: &wgpu::Buffer) -> wgpu::BindGroup {
        let entries = [entry(0, scene.as_entire_binding())];
        group(device, "scene", &self.scene_layout, &entries)
    }

    /// Binds what the ground is drawn from.
    pub fn ground_group(
        &self,
        device: &wgpu::Device,
        [density, picture]: [&wgpu::TextureView; 2],
        corners: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let entries = [
            entry(0, wgpu::BindingResource::TextureView(density)),
            entry(1, wgpu::BindingResource::TextureView(picture)),
            entry(2, wgpu::BindingResource::Sampler(&self.sampler)),
            entry(3, corners.as_entire_binding()),
        ];
        group(device, "ground", &self.ground_layout, &entries)
    }

    /// Binds a picture that is read.
    pub fn image_group(&self, device: &wgpu::Device, image: &wgpu::TextureView) -> wgpu::BindGroup {
        let entries = [entry(0, wgpu::BindingResource::TextureView(image))];
        group(device, "image", &self.image_layout, &entries)
    }
}

fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    entries: &[wgpu::BindGroupEntry<'_>],
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
}

/// Layouts of what is bound: numbers of the scene, what the ground is drawn from, a picture.
fn layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 3] {
    let texture = |filterable| BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let layout = |label, kinds: &[BindingType]| {
        let entries: Vec<wgpu::BindGroupLayoutEntry> = (0_u32..)
            .zip(kinds)
            .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: ShaderStages::VERTEX_FRAGMENT,
                ty: *ty,
                count: None,
            })
            .collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries };
        device.create_bind_group_layout(&descriptor)
    };
    let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let corners = buffer(wgpu::BufferBindingType::Storage { read_only: true });
    [
        layout("scene", &[buffer(wgpu::BufferBindingType::Uniform)]),
        layout("ground", &[texture(false), texture(true), sampler, corners]),
        layout("image", &[texture(false)]),
    ]
}

type Layout = wgpu::VertexBufferLayout<'static>;

fn area_layout() -> Layout {
    instances(
        AREA_BYTES,
        const { &vertex_attr_array![0 => Float32x4, 1 => Uint32x4, 2 => Unorm8x4] },
    )
}

fn stroke_layout() -> Layout {
    instances(
        STROKE_BYTES,
        const { &vertex_attr_array![0 => Float32x4, 1 => Float32x2, 2 => Unorm8x4] },
    )
}

fn shadow_layout() -> Layout {
    instances(
        SHADOW_BYTES,
        const { &vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x2] },
    )
}

fn part_layout() -> Layout {
    instances(
        PART_BYTES,
        const {
            &vertex_attr_array![
                3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4,
                8 => Float32x2
            ]
        },
    )
}

fn car_layout() -> Layout {
    let attributes = const { &vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4] };
    Layout { step_mode: wgpu::VertexStepMode::Vertex, ..instances(VERTEX_BYTES, attributes) }
}

fn instances(array_stride: u64, attributes: &'static [wgpu::VertexAttribute]) -> Layout {
    Layout { array_stride, step_mode: wgpu::VertexStepMode::Instance, attributes }
}

/// How the colour of a stage comes into a picture.
#[derive(Clone, Copy)]
struct Stage {
    blend: Option<wgpu::BlendState>,
    is_written: bool,
    is_strip: bool,
    /// How depths are compared, and whether they are written.
    depth: Option<(CompareFunction, bool)>,
}

impl Stage {
    const REPLACE: Self = Self { blend: None, is_written: true, is_strip: false, depth: None };
    const NOTHING: Self = Self { is_written: false, ..Self::REPLACE };
    /// Over what is there, by the opacity.
    const OVER: Self = Self { blend: Some(over(BlendFactor::SrcAlpha)), ..Self::REPLACE };
    /// The same, with colours that are multiplied by their opacity already.
    const PREMULTIPLIED: Self = Self { blend: Some(over(BlendFactor::One)), ..Self::REPLACE };
}

/// The picture stays opaque.
const fn over(src_factor: BlendFactor) -> wgpu::BlendState {
    let operation = wgpu::BlendOperation::Add;
    let dst_factor = BlendFactor::OneMinusSrcAlpha;
    wgpu::BlendState {
        color: wgpu::BlendComponent { src_factor, dst_factor, operation },
        alpha: wgpu::BlendComponent {
            src_factor: BlendFactor::Zero,
            dst_factor: BlendFactor::One,
            operation,
        },
    }
}

/// Makes pipelines of one file of shaders.
#[derive(Clone, Copy)]
struct Maker<'a> {
    device: &'a wgpu::Device,
    module: &'a wgpu::ShaderModule,
    groups: &'a [Option<&'a wgpu::BindGroupLayout>],
}

impl Maker<'_> {
    fn make(
        &self,
        vertex: &str,
        fragment: &str,
        buffers: &[Layout],
        stage: Stage,
    ) -> wgpu::RenderPipeline {
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(fragment),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let buffers: Vec<Option<Layout>> = buffers.iter().cloned().map(Some).collect();
        let has_mesh = buffers.len() > 1;
        let write_mask =
            if stage.is_written { wgpu::ColorWrites::ALL } else { wgpu::ColorWrites::empty() };
        let topology = match stage.is_strip {
            true => wgpu::PrimitiveTopology::TriangleStrip,
            false => wgpu::PrimitiveTopology::TriangleList,
        };
        let compilation_options = wgpu::PipelineCompilationOptions::default;
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(vertex),
                buffers: &buffers,
                compilation_options: compilation_options(),
            },
            primitive: wgpu::PrimitiveState {
                topology,
                // Meshes are closed, with corners counter-clockwise from outside.
                cull_mode: has_mesh.then_some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: stage.depth.map(|(compare, is_written)| wgpu::DepthStencilState {
                format: DEPTHS,
                depth_write_enabled: Some(is_written),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(fragment),
                targets: &[Some(wgpu::ColorTargetState {
                    format: COLORS,
                    blend: stage.blend,
                    write_mask,
                })],
                compilation_options: compilation_options(),
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
