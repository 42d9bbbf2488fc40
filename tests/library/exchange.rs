//! What is written for other programs, read back.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;

use dxf::Drawing;
use dxf::entities::EntityType;
use gltf::animation::util::ReadOutputs;
use impactlab_core::site::SiteOrigin;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, UnitSystem};
use impactlab_core::vehicle::Wheel;
use impactlab_document::exchange::{DxfOptions, GltfFrame, dxf, glb, hve_motion, hve_pulse};
use impactlab_document::scene::{
    CarLook, Scene, SceneGround, ScenePath, SceneRole, SimulationScene, simulation_scene,
};
use impactlab_study::{
    Library, MotionSource, Question, ScenarioChoice, SeriesFile, SimulateAnswer, SimulateRequest,
};

/// The shipped scenario, simulated, and its scene.
fn case() -> (SimulateAnswer, Scene) {
    let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
    simulated(MotionSource::Scenario { scenario, pulse: Default::default() })
}

/// A motion and its scene.
fn simulated(source: MotionSource) -> (SimulateAnswer, Scene) {
    // Each vehicle for itself, so that something restricts the motion.
    let request = SimulateRequest {
        vehicle_draws: Some(0),
        one_contact: true,
        ..SimulateRequest::new(source)
    };
    let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    let answer = answer.expect("a motion").complete().expect("not cancelled");
    let caveats = answer.report.caveats.clone();
    let scene = simulation_scene(&SimulationScene {
        analysis: &answer.analysis,
        others: &[],
        units: UnitSystem::Si,
        caveats: &caveats,
    });
    (answer, scene)
}

#[test]
fn a_drawing_has_metres_layers_closed_outlines_and_restrictions() {
    let (_, scene) = case();
    let instants = [0.0, 0.5, 1.25];
    let options = DxfOptions { outlines_s: instants.to_vec() };
    let [mut first, mut second] = [Vec::new(), Vec::new()];
    dxf(&scene, &options, &mut first).expect("a drawing");
    dxf(&scene, &options, &mut second).expect("a drawing");
    assert!(first == second, "the same scene gives the same drawing");
    let drawing = Drawing::load(&mut first.as_slice()).expect("a drawing that can be read");
    assert_eq!(drawing.header.default_drawing_units, dxf::enums::Units::Meters);
    assert_eq!(drawing.header.drawing_units, dxf::enums::DrawingUnits::Metric);
    let text = String::from_utf8_lossy(&first);
    let variable = |name: &str| {
        let mut lines = text.lines().map(str::trim).skip_while(|line| *line != name);
        lines.nth(2).map(str::to_owned)
    };
    assert_eq!(variable("$INSUNITS").as_deref(), Some("6"), "metres");
    assert_eq!(variable("$MEASUREMENT").as_deref(), Some("1"), "metric");
    let layers: Vec<&str> = drawing.layers().map(|layer| layer.name.as_str()).collect();
    for layer in ["SIMULATED_PATH", "SIMULATED_OUTLINE", "STRIKING_PATH", "RESTRICTIONS"] {
        assert!(layers.contains(&layer), "{layer} in {layers:?}");
    }
    let outlines = |layer: &str| -> Vec<Vec<[f64; 2]>> {
        let of_layer = drawing.entities().filter(|entity| entity.common.layer == layer);
        let closed = of_layer.filter_map(|entity| match &entity.specific {
            EntityType::LwPolyline(line) if line.is_closed() => Some(line),
            _ => None,
        });
        closed.map(|line| line.vertices.iter().map(|of| [of.x, of.y]).collect()).collect()
    };
    let car = scene.struck().expect("a struck car");
    let drawn = outlines("SIMULATED_OUTLINE");
    assert_eq!(drawn.len(), instants.len());
    for (outline, time_s) in drawn.iter().zip(instants) {
        let (pose, body) = (car.at(time_s).pose, &car.shape.body);
        let front_left = pose.world_from_body([body.front_m, body.width_m / 2.0]);
        let off = (outline[0][0] - front_left[0]).hypot(outline[0][1] - front_left[1]);
        assert!(outline.len() == 4 && off < 1e-9, "at {time_s} s: {outline:?}, {front_left:?}");
    }
    let path = drawing.entities().find_map(|entity| match &entity.specific {
        EntityType::LwPolyline(line) if entity.common.layer == "SIMULATED_PATH" => Some(line),
        _ => None,
    });
    assert_eq!(path.expect("a path").vertices.len(), car.motion.states().len());
    let texts: Vec<&str> = drawing
        .entities()
        .filter_map(|entity| match &entity.specific {
            EntityType::Text(text) => Some(text.value.as_str()),
            _ => None,
        })
        .collect();
    assert!(texts.iter().any(|text| text.contains("second contact")), "{texts:?}");
    assert!(texts.iter().any(|text| text.contains("0.500 s")), "{texts:?}");
}

/// All variants had one colour, and no line was dashed.
#[test]
fn each_variant_has_its_colour_and_its_dashes() {
    let (_, mut scene) = case();
    let path = scene.paths.first().expect("a path").clone();
    let roles = [0, 1, 2].map(SceneRole::Variant);
    scene.paths =
        roles.map(|role| ScenePath { role, is_dashed: role.is_dashed(), ..path.clone() }).to_vec();
    let mut bytes = Vec::new();
    dxf(&scene, &DxfOptions::default(), &mut bytes).expect("a drawing");
    let drawing = Drawing::load(&mut bytes.as_slice()).expect("a drawing that can be read");
    let layers = drawing.layers().filter(|layer| layer.name.starts_with("VARIANT_"));
    let colors: BTreeSet<Option<u8>> = layers.map(|layer| layer.color.index()).collect();
    assert_eq!(colors.len(), 3, "{colors:?}");
    let paths: Vec<_> = drawing
        .entities()
        .filter(|entity| entity.common.layer.starts_with("VARIANT_"))
        .map(|entity| entity.common.line_type_name.as_str())
        .collect();
    assert_eq!(paths, ["DASHED_10", "DASHED_5", "DASHED_18"]);
    for name in paths {
        let line_type = drawing.line_types().find(|of| of.name == name).expect("a line type");
        let [dash, gap] = line_type.dash_dot_space_lengths[..] else { panic!("{line_type:?}") };
        assert!(dash > 0.0 && gap < 0.0, "{line_type:?}");
        assert!((line_type.total_pattern_length - dash + gap).abs() < 1e-9, "{line_type:?}");
    }
    let mut bytes = Vec::new();
    glb(&scene, &mut bytes).expect("a scene");
    let file = gltf::Gltf::from_slice(&bytes).expect("a valid file");
    let color = |name: &str| {
        let material = file.materials().find(|of| of.name() == Some(name)).expect("a material");
        material.pbr_metallic_roughness().base_color_factor()
    };
    let [a, b, c] = ["VARIANT_1 line", "VARIANT_2 line", "VARIANT_3 line"].map(color);
    assert!(a != b && b != c && c != a, "{a:?} {b:?} {c:?}");
}

/// A vector turned by a unit quaternion `[x, y, z, w]`.
fn turned([x, y, z, w]: [f32; 4], v: [f64; 3]) -> [f64; 3] {
    let ([x, y, z, w], u) = ([x, y, z, w].map(f64::from), v);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let t = cross([x, y, z], u).map(|value| 2.0 * value);
    let second = cross([x, y, z], t);
    std::array::from_fn(|i| u[i] + w * t[i] + second[i])
}

/// A recorded motion at a clock that counts from 1970, in survey coordinates.
fn surveyed() -> (SimulateAnswer, Scene) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("survey.csv");
    let mut rows = "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,yaw_rate_rad_s\n".to_owned();
    for idx in 0..=200 {
        let time_s = f64::from(idx) * 0.01;
        let (x_m, y_m) = (512_345.25 + 15.0 * time_s, 5_423_456.37);
        rows += &format!("{:.2},{x_m:.4},{y_m:.4},0,15,0,0\n", 1.7e9 + time_s);
    }
    std::fs::write(&path, rows).expect("written");
    simulated(MotionSource::Trajectory { file: SeriesFile::new(&path), contact: None })
}

#[test]
fn a_clock_from_1970_and_survey_coordinates_keep_their_precision() {
    let (answer, scene) = surveyed();
    let frame = GltfFrame::new(&scene);
    assert_eq!((frame.start_s, frame.origin_m), (1.7e9, [512_000.0, 5_423_000.0]));
    let notes = frame.notes().join("\n");
    for part in ["time 0 of the animation is 1700000000 s", "X 512000 m, Y 5423000 m"] {
        assert!(notes.contains(part), "{notes}");
    }
    let mut bytes = Vec::new();
    glb(&scene, &mut bytes).expect("a scene");
    let file = gltf::Gltf::from_slice(&bytes).expect("a valid file");
    let blob = file.blob.as_deref().expect("numbers");
    let animation = file.animations().next().expect("an animation");
    let channel = animation
        .channels()
        .find(|channel| channel.target().property() == gltf::animation::Property::Translation);
    let channel = channel.expect("a car that moves");
    let reader = channel.reader(|_| Some(blob));
    let times: Vec<f32> = reader.read_inputs().expect("times").collect();
    assert_eq!(times[0], 0.0, "no time is negative");
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "times grow: {:?}", &times[..4]);
    assert!((times[times.len() - 1] - 2.0).abs() < 1e-3, "{:?}", times.last());
    let Some(ReadOutputs::Translations(places)) = reader.read_outputs() else { panic!("places") };
    let places: Vec<[f32; 3]> = places.collect();
    let first = scene.struck().expect("a car").motion.states()[0].pose;
    for (got, expected) in places[0].iter().zip([first.x_m - 512_000.0, first.y_m - 5_423_000.0]) {
        assert!((f64::from(*got) - expected).abs() < 1e-4, "{:?} for {first:?}", places[0]);
    }
    let head = String::from_utf8_lossy(&bytes);
    assert!(
        head.contains("\"extras\":{\"origin_m\":[512000.0,5423000.0],\"time_0_s\":1700000000.0}")
    );

    // Drawing and tables have their numbers in double precision.
    let mut drawing = Vec::new();
    let outlines_s = vec![scene.end_s];
    dxf(&scene, &DxfOptions { outlines_s }, &mut drawing).expect("a drawing");
    let drawing = Drawing::load(&mut drawing.as_slice()).expect("a drawing that can be read");
    let ys = drawing.entities().filter_map(|entity| match &entity.specific {
        EntityType::LwPolyline(line) if entity.common.layer == "RECORDED_PATH" => {
            line.vertices.first().map(|of| of.y)
        }
        _ => None,
    });
    let ys: Vec<f64> = ys.collect();
    assert!(ys.iter().all(|y| (y - 5_423_456.37).abs() < 1e-6) && !ys.is_empty(), "{ys:?}");
    let mut table = Vec::new();
    hve_motion(&answer.analysis, None, &mut table).expect("a motion");
    let table = String::from_utf8(table).expect("UTF-8");
    let first = table.lines().find(|line| line.starts_with("17")).expect("rows");
    let cells: Vec<f64> = first.split('\t').map_while(|cell| cell.parse().ok()).take(3).collect();
    assert_eq!(cells[0], 1.7e9);
    assert!((cells[2] * 0.3048 + 5_423_456.37).abs() < 1e-3, "{cells:?}");
}

#[test]
fn restrictions_are_in_the_units_of_the_reader_and_coordinates_in_metres() {
    let (_, mut scene) = case();
    let speed = PhraseValue::three_digits(Quantity::Speed, 44.704);
    let text = Phrase::new("learned up to {0}", "gelernt bis {0}").with(speed);
    scene.caveats = [Caveat::new(CaveatKind::OutsideDomain, text)].into_iter().collect();
    let written = |units: UnitSystem| {
        let scene = Scene { units, ..scene.clone() };
        let [mut drawing, mut animation] = [Vec::new(), Vec::new()];
        dxf(&scene, &DxfOptions::default(), &mut drawing).expect("a drawing");
        glb(&scene, &mut animation).expect("an animation");
        [drawing, animation].map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
    };
    for (units, said) in
        [(UnitSystem::Us, "learned up to 100 mph"), (UnitSystem::Si, "learned up to 161 km/h")]
    {
        let [drawing, animation] = written(units);
        assert!(drawing.contains(said), "{units:?}: {said}");
        assert!(animation.contains(said), "{units:?}: {said}");
        assert!(drawing.contains("metres, X along the road"), "{units:?}");
    }
}

#[test]
fn a_drawing_says_where_its_site_lies() {
    let (_, mut scene) = case();
    let restrictions = |scene: &Scene| {
        let mut bytes = Vec::new();
        dxf(scene, &DxfOptions::default(), &mut bytes).expect("a drawing");
        String::from_utf8_lossy(&bytes).into_owned()
    };
    assert!(!restrictions(&scene).contains("axes of the site"));
    let survey_m = [512_345.0, 5_423_456.0];
    let origin = SiteOrigin { survey_m, x_axis_azimuth_rad: 78_f64.to_radians() };
    let ground = SceneGround { origin: Some(origin), ..SceneGround::default() };
    scene.ground = Some(std::sync::Arc::new(ground));
    let text =
        "origin at easting 512345 m, northing 5423456 m, X at 78.000000 deg clockwise from grid";
    assert!(restrictions(&scene).contains(text));
    scene.ground = Some(std::sync::Arc::new(SceneGround::default()));
    assert!(restrictions(&scene).contains("which has no origin in survey coordinates"));
}

/// The lists of a glTF file of one component, two, three or four: its numbers by accessor.
fn numbers(file: &gltf::Gltf, accessor: &gltf::Accessor<'_>) -> Vec<Vec<f32>> {
    let blob = file.blob.as_deref().expect("numbers");
    let view = accessor.view().expect("a view");
    let (start, n) = (view.offset() + accessor.offset(), accessor.dimensions().multiplicity());
    assert!(start.is_multiple_of(4) && view.offset() + view.length() <= blob.len());
    assert_eq!(view.length(), 4 * n * accessor.count(), "a view holds its list and no more");
    let bytes = &blob[start..start + 4 * n * accessor.count()];
    let single = |four: &[u8]| f32::from_le_bytes(four.try_into().expect("four bytes"));
    bytes.chunks(4 * n).map(|row| row.chunks(4).map(single).collect()).collect()
}

/// What the validator of the Khronos Group checks; it found 48 normals without a length.
#[test]
fn a_scene_in_gltf_has_what_its_validator_asks_for() {
    let (_, pit) = case();
    // A scene in which nothing moves has no two keys at one time.
    let still = Scene { end_s: 0.0, ..pit.clone() };
    for (scene, is_moving) in [(&pit, true), (&still, false)] {
        let mut bytes = Vec::new();
        glb(scene, &mut bytes).expect("a scene");
        let file = gltf::Gltf::from_slice(&bytes).expect("a valid file");
        for accessor in file.accessors() {
            let rows = numbers(&file, &accessor);
            assert!(rows.iter().flatten().all(|value| value.is_finite()));
            for (ends, pick) in
                [(accessor.min(), f32::min as fn(f32, f32) -> f32), (accessor.max(), f32::max)]
            {
                let told: Vec<f64> = serde_json::from_value(ends.expect("ends")).expect("numbers");
                for (axis, told) in told.iter().enumerate() {
                    let found = rows.iter().map(|row| row[axis]).reduce(pick).expect("a row");
                    assert_eq!(f64::from(found), *told, "accessor {}", accessor.index());
                }
            }
        }
        let size = |row: &Vec<f32>| row.iter().map(|v| v * v).sum::<f32>().sqrt();
        for part in file.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
            let positions = part.get(&gltf::Semantic::Positions).expect("positions");
            let Some(normals) = part.get(&gltf::Semantic::Normals) else { continue };
            assert_eq!(positions.count(), normals.count());
            assert!(positions.count().is_multiple_of(3), "triangles");
            let rows = numbers(&file, &normals);
            assert!(rows.iter().all(|row| (size(row) - 1.0).abs() < 5e-4), "{rows:?}");
        }
        let animation = file.animations().next().expect("an animation");
        for sampler in animation.samplers() {
            let (times, values) = (sampler.input(), sampler.output());
            assert_eq!(times.count(), values.count());
            let times = numbers(&file, &times);
            assert!(times.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{times:?}");
            assert_eq!(times.len() > 1, is_moving);
            let rows = numbers(&file, &values);
            let is_rotation = rows[0].len() == 4;
            assert!(!is_rotation || rows.iter().all(|row| (size(row) - 1.0).abs() < 5e-4));
        }
    }
}

#[test]
fn keys_of_the_animation_are_the_poses_of_the_scene() {
    let (_, scene) = case();
    let mut bytes = Vec::new();
    glb(&scene, &mut bytes).expect("a scene");
    let file = gltf::Gltf::from_slice(&bytes).expect("a valid file");
    let blob = file.blob.as_deref().expect("numbers");
    let animation = file.animations().next().expect("an animation");
    // Of each car: body and four wheels turn, the car turns and moves.
    let n_cars = scene.cars.iter().filter(|car| car.look == CarLook::Solid).count();
    assert_eq!(animation.channels().count(), 7 * n_cars);
    let car = scene.cars.iter().find(|car| car.role == SceneRole::Simulated).expect("a car");
    let channels = |name: &str| {
        let name = name.to_owned();
        animation.channels().filter(move |channel| channel.target().node().name() == Some(&name))
    };
    let rotations = |name: &str| -> Vec<[f32; 4]> {
        let lists = channels(name).filter_map(|channel| {
            match channel.reader(|_| Some(blob)).read_outputs()? {
                ReadOutputs::Rotations(all) => Some(all.into_f32().collect::<Vec<_>>()),
                _ => None,
            }
        });
        lists.into_iter().next().expect("rotations")
    };
    let places: Vec<[f32; 3]> = channels(&car.name)
        .find_map(|channel| match channel.reader(|_| Some(blob)).read_outputs()? {
            ReadOutputs::Translations(all) => Some(all.collect()),
            _ => None,
        })
        .expect("places");
    let times: Vec<f32> = channels(&car.name)
        .next()
        .and_then(|of| Some(of.reader(|_| Some(blob)).read_inputs()?.collect()))
        .expect("times");
    assert_eq!(places.len(), times.len());
    assert!((f64::from(times[times.len() - 1]) - scene.end_s).abs() < 1e-4);
    let (yaw, body) = (rotations(&car.name), rotations(&format!("{} body", car.name)));
    let wheel = rotations(&format!("{} wheel FrontLeft", car.name));
    for (idx, time_s) in times.iter().enumerate() {
        let state = car.at(f64::from(*time_s));
        let pose = state.pose;
        let off =
            (f64::from(places[idx][0]) - pose.x_m).hypot(f64::from(places[idx][1]) - pose.y_m);
        assert!(off < 1e-3 && places[idx][2] == 0.0, "at {time_s} s: {off} m");
        let near = |a: [f64; 3], b: [f64; 3], what: &str| {
            let off = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
            assert!(off < 5e-3, "{what} at {time_s} s: {a:?} instead of {b:?}");
        };
        let (sin, cos) = pose.yaw_rad.sin_cos();
        near(turned(yaw[idx], [1.0, 0.0, 0.0]), [cos, sin, 0.0], "heading");
        let (sin, cos) = state.roll_rad.sin_cos();
        near(turned(body[idx], [0.0, 1.0, 0.0]), [0.0, cos, sin], "roll");
        // A wheel turns from z towards x and is then steered.
        let (turn, steer) = (state.turned_rad[Wheel::FrontLeft.index()], state.steer_rad[0]);
        let top = [turn.sin() * steer.cos(), turn.sin() * steer.sin(), turn.cos()];
        near(turned(wheel[idx], [0.0, 0.0, 1.0]), top, "wheel");
    }
    // Y of glTF is up: the root turns the up of the scene to it.
    let root = file.nodes().find(|node| node.name() == Some("scene")).expect("a root");
    let (_, rotation, _) = root.transform().decomposed();
    let up = turned(rotation, [0.0, 0.0, 1.0]);
    assert!((up[1] - 1.0).abs() < 1e-6, "{up:?}");
    assert!(bytes.windows(14).any(|part| part == b"second contact"), "restrictions are told");
}

#[test]
fn tables_for_hve_have_its_units_and_signs() {
    let (answer, _) = case();
    let analysis = &answer.analysis;
    let [mut pulse, mut motion] = [Vec::new(), Vec::new()];
    hve_pulse(analysis, Some("assumed: a pulse"), &mut pulse).expect("a pulse");
    hve_motion(analysis, None, &mut motion).expect("a motion");
    let rows = |text: &str| -> (Vec<String>, Vec<Vec<f64>>) {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let header = lines.next().expect("names").split('\t').map(str::to_owned).collect();
        let number = |cell: &str| -> f64 { cell.parse().expect("a number") };
        (header, lines.map(|line| line.split('\t').map(number).collect()).collect())
    };
    let text = String::from_utf8(pulse).expect("UTF-8");
    assert!(text.contains("# restrictions: assumed: a pulse\n"), "{text}");
    let (header, pulse) = rows(&text);
    assert_eq!(header[..3], ["Time (sec)", "Fx (lb)", "Fy (lb)"]);
    // The impulse, summed over the rows, in N s.
    let lbf_n = 4.448_221_615_260_5;
    let sum = |column: usize| -> f64 {
        pulse.windows(2).map(|w| (w[1][0] - w[0][0]) * w[0][column] * lbf_n).sum()
    };
    let size = sum(1).hypot(sum(2));
    assert!((size - 3026.0).abs() < 40.0, "{size} N s");
    // The struck vehicle is hit from its right and pushed to its left: negative y of SAE.
    assert!(sum(2) < 0.0 && pulse.iter().all(|row| row.iter().all(|v| v.is_finite())));
    // What is not a column is not said to be unknown beside what it follows from.
    assert!(text.contains("Mz is missing as a column: it follows from the point"), "{text}");
    assert!(text.contains("axes of SAE J670, of the vehicle: x forward, y right"), "{text}");
    assert!(text.contains("# point of contact: x -"), "{text}");
    let mass_kg = analysis.vehicle.mass.mass_kg;
    let row = pulse.iter().max_by(|a, b| a[2].abs().total_cmp(&b[2].abs())).expect("rows");
    let side_g = row[2] * lbf_n / mass_kg / 9.806_65;
    assert!((row[4] - side_g).abs() < 1e-3, "{row:?}: {side_g} g");

    let text = String::from_utf8(motion).expect("UTF-8");
    assert!(text.contains("X and Y of the ground, Y to the right of X"), "{text}");
    let (header, motion) = rows(&text);
    assert_eq!(header[..3], ["Time (sec)", "X (ft)", "Y (ft)"]);
    let series = &analysis.simulation.as_ref().expect("a motion").series;
    assert_eq!(motion.len(), series.n_samples());
    let last = motion.last().expect("rows");
    let end = |channel| *series.get(channel).and_then(|v| v.last()).expect("a channel");
    use impactlab_core::data::Channel::{X, Y, Yaw};
    assert!((last[1] * 0.3048 - end(X)).abs() < 1e-3, "{last:?}");
    assert!((last[2] * 0.3048 + end(Y)).abs() < 1e-3, "{last:?}");
    assert!((last[3] + end(Yaw).to_degrees()).abs() < 1e-3, "{last:?}");
}
