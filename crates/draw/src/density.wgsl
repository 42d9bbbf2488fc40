// Density of a planar mixture at the points of a grid, relative to the largest peak of a part:
//
//   p(i, j) = Σ_k c_k 2^−(a_k u² + d_k v²)     v = j − m_y     u = (i − m_x) − slope · v
//
// Lengths are in cells of the grid; a and d include the factor ½ log₂ e. Each mean is stored as a
// whole cell and a remainder, so that differences keep their precision however far a point lies
// from the corner of the grid.
//
// A workgroup computes a tile of 16 × 16 points. It processes the kernels in chunks of 256: each
// invocation loads one kernel and marks it if it reaches into the tile; then all invocations add
// the marked kernels in their order.

struct Grid {
    size: vec2<u32>,
    n_kernels: u32,
}

struct Kernel {
    cell: vec2<f32>,
    rest: vec2<f32>,
    // The coefficients a and d.
    fall: vec2<f32>,
    slope: f32,
    // c divided by the largest c.
    peak: f32,
}

const SIDE: u32 = 16u;
const CHUNK: u32 = 256u;
const N_WORDS: u32 = 8u;
// ½ log₂ e times the square of eight standard deviations, beyond which a kernel is neglected.
const LIMIT: f32 = 46.166241;

@group(0) @binding(0) var<uniform> grid: Grid;
@group(0) @binding(1) var<storage, read> kernels: array<Kernel>;
@group(0) @binding(2) var<storage, read_write> values: array<f32>;

var<workgroup> chunk: array<Kernel, CHUNK>;
// One bit for each kernel of the chunk, set if the kernel reaches into the tile.
var<workgroup> marks: array<atomic<u32>, N_WORDS>;

// Whether a kernel reaches into the tile whose corners are low and low + 15.
fn reaches(kernel: Kernel, low: vec2<f32>) -> bool {
    let reach = sqrt(vec2<f32>(LIMIT) / kernel.fall);
    let near = (low - kernel.cell) - kernel.rest;
    let far = near + vec2<f32>(f32(SIDE) - 1.0);
    // Rows of the tile within reach, relative to the mean, and the centres of the kernel along x in
    // the first and the last of them.
    let rows = vec2<f32>(max(near.y, -reach.y), min(far.y, reach.y));
    let centres = kernel.slope * rows;
    let left = min(centres.x, centres.y) - reach.x;
    let right = max(centres.x, centres.y) + reach.x;
    return rows.x <= rows.y && left <= far.x && near.x <= right;
}

fn density(kernel: Kernel, at: vec2<f32>) -> f32 {
    let from_mean = (at - kernel.cell) - kernel.rest;
    let u = from_mean.x - kernel.slope * from_mean.y;
    let fall = kernel.fall.x * u * u + kernel.fall.y * from_mean.y * from_mean.y;
    return select(0.0, kernel.peak * exp2(-fall), fall <= LIMIT);
}

@compute @workgroup_size(16, 16)
fn main(
    @builtin(workgroup_id) tile: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let corner = tile.xy * SIDE;
    let point = corner + local.xy;
    let at = vec2<f32>(point);
    var sum = 0.0;
    for (var first = 0u; first < grid.n_kernels; first += CHUNK) {
        if index < N_WORDS {
            atomicStore(&marks[index], 0u);
        }
        workgroupBarrier();
        if first + index < grid.n_kernels {
            let kernel = kernels[first + index];
            chunk[index] = kernel;
            if reaches(kernel, vec2<f32>(corner)) {
                atomicOr(&marks[index / 32u], 1u << (index % 32u));
            }
        }
        workgroupBarrier();
        // Each chunk is summed separately, which reduces rounding errors.
        var part = 0.0;
        for (var word = 0u; word < N_WORDS; word++) {
            var bits = atomicLoad(&marks[word]);
            while bits != 0u {
                part += density(chunk[32u * word + countTrailingZeros(bits)], at);
                bits &= bits - 1u;
            }
        }
        sum += part;
        workgroupBarrier();
    }
    if all(point < grid.size) {
        values[point.y * grid.size.x + point.x] = sum;
    }
}
