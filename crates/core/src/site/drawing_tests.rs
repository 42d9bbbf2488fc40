use dxf::entities::{Circle, Entity, EntityType, Insert, Line, LwPolyline, Polyline, Text, Vertex};
use dxf::enums::{AcadVersion, Units};
use dxf::{LwPolylineVertex, Point};

use crate::site::{DrawingFile, LengthUnit, SiteOrigin, read_drawing};
use crate::units::UnitSystem;

fn on(layer: &str, specific: EntityType) -> Entity {
    let mut entity = Entity::new(specific);
    entity.common.layer = layer.to_owned();
    entity
}

fn line(from: [f64; 2], to: [f64; 2]) -> EntityType {
    let point = |[x, y]: [f64; 2]| Point::new(x, y, 0.0);
    EntityType::Line(Line::new(point(from), point(to)))
}

fn saved(drawing: &dxf::Drawing) -> (tempfile::TempDir, DrawingFile) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("survey.dxf");
    drawing.save_file(&file).unwrap();
    (folder, DrawingFile { file, unit: None, layers: None })
}

#[test]
fn lines_come_back_in_metres_and_in_the_axes_of_the_site() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Millimeters;
    let far = [3.5e9, 5.4e9];
    let at = |x: f64, y: f64| [far[0] + x, far[1] + y];
    drawing.add_entity(on("KERB", line(at(0.0, 0.0), at(10_000.0, 0.0))));
    let vertex = |x: f64, y: f64, bulge| LwPolylineVertex {
        x: far[0] + x,
        y: far[1] + y,
        bulge,
        ..Default::default()
    };
    let vertices =
        vec![vertex(0.0, 0.0, 0.0), vertex(2000.0, 0.0, 1.0), vertex(2000.0, 4000.0, 0.0)];
    let mut closed = LwPolyline { vertices, ..LwPolyline::default() };
    closed.set_is_closed(true);
    drawing.add_entity(on("ROAD", EntityType::LwPolyline(closed)));
    drawing.add_entity(on("ROAD", EntityType::Text(Text::default())));
    let (_folder, mut file) = saved(&drawing);
    let origin = SiteOrigin { survey_m: [3.5e6, 5.4e6], ..SiteOrigin::default() };
    let read = read_drawing(&file, &origin).unwrap();
    assert_eq!(read.lines.len(), 2);
    let [from, to] = [read.lines[0].points_m[0], read.lines[0].points_m[1]];
    assert!(from[0].hypot(from[1]) < 1e-6 && (to[0] - 10.0).hypot(to[1]) < 1e-6, "{to:?}");
    let outline = &read.lines[1].points_m;
    assert_eq!(outline.first(), outline.last());
    let widest = outline.iter().map(|point| point[0]).fold(0.0, f64::max);
    assert!((widest - 4.0).abs() < 1e-6, "the arc reaches 2 m beyond its chord: {widest}");
    assert_eq!(read.left_out.get("Text"), Some(&1));
    file.layers = Some(vec!["KERB".to_owned()]);
    assert_eq!(read_drawing(&file, &origin).unwrap().lines.len(), 1);
    file.layers = Some(vec!["WALL".to_owned()]);
    let error = read_drawing(&file, &origin).unwrap_err().to_string();
    assert!(error.ends_with("has no layer \"WALL\", expected one of KERB, ROAD"), "{error}");
}

#[test]
fn the_unit_has_to_be_known_and_the_coordinates_possible() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.add_entity(on("0", line([0.0, 0.0], [3.0e7, 1.0])));
    let (_folder, mut file) = saved(&drawing);
    let origin = SiteOrigin::default();
    let error = read_drawing(&file, &origin).unwrap_err().to_string();
    assert!(error.contains("does not say in which unit it is drawn"), "{error}");
    file.unit = Some(LengthUnit::Metre);
    let error = read_drawing(&file, &origin).unwrap_err().to_string();
    assert!(error.contains("is the unit right?"), "{error}");
    file.unit = Some(LengthUnit::Foot);
    let read = read_drawing(&file, &origin).unwrap();
    assert!((read.lines[0].points_m[1][0] - 9.144e6).abs() < 1e-6);
}

/// A polyline that was smoothed has the corners from which its curve was made, too.
#[test]
fn the_frame_of_a_smoothed_polyline_is_not_drawn() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Meters;
    let mut curve = Polyline::default();
    curve.set_spline_fit_vertices_added(true);
    for (x, y, is_frame) in [
        (0.0, 0.0, true),
        (5.0, 20.0, true),
        (10.0, 0.0, true),
        (0.0, 0.0, false),
        (5.0, 10.0, false),
    ] {
        let mut vertex = Vertex::new(Point::new(x, y, 0.0));
        vertex.set_is_spline_frame_control_point(is_frame);
        vertex.set_is_spline_vertex_created_by_spline_fitting(!is_frame);
        curve.add_vertex(&mut drawing, vertex);
    }
    drawing.add_entity(on("KERB", EntityType::Polyline(curve)));
    let (_folder, file) = saved(&drawing);
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!(read.lines[0].points_m, [[0.0, 0.0], [5.0, 10.0]]);
}

#[test]
fn blocks_are_turned_scaled_and_placed() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Meters;
    let mut block = dxf::Block { name: "SIGN".to_owned(), ..Default::default() };
    block.base_point = Point::new(1.0, 0.0, 0.0);
    block.entities.push(on("0", line([1.0, 0.0], [2.0, 0.0])));
    let circle = Circle::new(Point::new(1.0, 1.0, 0.0), 0.5);
    block.entities.push(on("0", EntityType::Circle(circle)));
    drawing.add_block(block);
    let insert = Insert {
        name: "SIGN".to_owned(),
        location: Point::new(10.0, 20.0, 0.0),
        rotation: 90.0,
        x_scale_factor: 2.0,
        y_scale_factor: 2.0,
        ..Insert::default()
    };
    drawing.add_entity(on("SIGNS", EntityType::Insert(insert)));
    let (_folder, file) = saved(&drawing);
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!(read.lines.len(), 2);
    assert!(read.lines.iter().all(|line| line.layer == "SIGNS"));
    let [from, to] = [read.lines[0].points_m[0], read.lines[0].points_m[1]];
    assert!((from[0] - 10.0).hypot(from[1] - 20.0) < 1e-9, "{from:?}");
    assert!((to[0] - 10.0).hypot(to[1] - 22.0) < 1e-9, "{to:?}");
    let circle = &read.lines[1].points_m;
    assert!(circle.iter().all(|p| ((p[0] - 8.0).hypot(p[1] - 20.0) - 1.0).abs() < 1e-9));
}

/// Programs for roads write kinds of their own, which the reader of drawings passes over.
#[test]
fn kinds_of_other_programs_are_counted_on_layers_that_are_shown() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Meters;
    drawing.add_entity(on("KERB", line([0.0, 0.0], [10.0, 0.0])));
    let (_folder, mut file) = saved(&drawing);
    let text = std::fs::read_to_string(&file.file).unwrap().replace("\r\n", "\n");
    let at = text.find("ENTITIES\n").unwrap() + "ENTITIES\n".len();
    let (head, rest) = text.split_at(at);
    let feature = "  0\nAECC_FEATURE_LINE\n  8\nROAD\n";
    std::fs::write(&file.file, format!("{head}{feature}{rest}")).unwrap();
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!((read.lines.len(), read.left_out.get("AECC_FEATURE_LINE")), (1, Some(&1)));
    file.layers = Some(vec!["KERB".to_owned()]);
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert!(read.left_out.is_empty(), "{:?}", read.left_out);
}

/// A drawing that refers to others, as to the survey below a plan, has only their names.
#[test]
fn a_drawing_within_a_drawing_is_counted() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Meters;
    let mut base = dxf::Block { name: "BASE".to_owned(), ..Default::default() };
    base.set_is_xref(true);
    base.xref_path_name = "base.dwg".to_owned();
    drawing.add_block(base);
    let insert = Insert { name: "BASE".to_owned(), ..Insert::default() };
    drawing.add_entity(on("0", EntityType::Insert(insert)));
    drawing.add_entity(on("KERB", line([0.0, 0.0], [10.0, 0.0])));
    let (_folder, file) = saved(&drawing);
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!(read.left_out.get("INSERT of another drawing"), Some(&1), "{:?}", read.left_out);
}

#[test]
fn what_is_off_frozen_or_invisible_is_neither_drawn_nor_counted() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Meters;
    for (name, is_layer_on) in [("KERB", true), ("OFF", false), ("FROZEN", true)] {
        let layer = dxf::tables::Layer { name: name.to_owned(), is_layer_on, ..Default::default() };
        drawing.add_layer(layer);
        drawing.add_entity(on(name, line([0.0, 0.0], [3.0, 1.0])));
        drawing.add_entity(on(name, EntityType::Text(Text::default())));
    }
    let mut invisible = on("KERB", line([0.0, 0.0], [9.0, 9.0]));
    invisible.common.is_visible = false;
    drawing.add_entity(invisible);
    // A frozen insert hides what its block has, also on other layers; one that is off does not.
    let mut block = dxf::Block { name: "SIGN".to_owned(), ..Default::default() };
    block.entities.push(on("KERB", line([0.0, 0.0], [5.0, 0.0])));
    drawing.add_block(block);
    for layer in ["FROZEN", "OFF"] {
        let insert = Insert { name: "SIGN".to_owned(), ..Insert::default() };
        drawing.add_entity(on(layer, EntityType::Insert(insert)));
    }
    let (_folder, mut file) = saved(&drawing);
    let text = std::fs::read_to_string(&file.file).unwrap();
    let (head, tail) = text.split_once("\r\nFROZEN\r\n").unwrap();
    let frozen = tail.replacen("\r\n     0\r\n", "\r\n     1\r\n", 1);
    std::fs::write(&file.file, format!("{head}\r\nFROZEN\r\n{frozen}")).unwrap();
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    let ends: Vec<[f64; 2]> = read.lines.iter().map(|line| line.points_m[1]).collect();
    assert_eq!(ends, [[3.0, 1.0], [5.0, 0.0]], "{:?}", read.lines);
    assert_eq!(read.left_out.get("Text"), Some(&1), "{:?}", read.left_out);
    let notes = read.notes(std::path::Path::new("survey.dxf"));
    assert!(notes.iter().any(|note| note == "survey.dxf: not drawn: 1 Text"), "{notes:?}");
    file.layers = Some(vec!["FROZEN".to_owned()]);
    let chosen = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!(chosen.lines.len(), 1, "a layer that is asked for is drawn");
}

#[test]
fn a_large_arc_in_millimetres_is_within_5_mm_of_its_chords() {
    let mut drawing = dxf::Drawing::new();
    drawing.header.version = AcadVersion::R2010;
    drawing.header.default_drawing_units = Units::Millimeters;
    let circle = Circle::new(Point::new(0.0, 0.0, 0.0), 1e6);
    drawing.add_entity(on("KERB", EntityType::Circle(circle)));
    let (_folder, file) = saved(&drawing);
    let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
    assert_eq!(
        read.summary().contents(UnitSystem::Si),
        " in mm, 1 line, X -1000.0 to 1000.0 m, Y -1000.0 to 1000.0 m"
    );
    for pair in read.lines[0].points_m.windows(2) {
        let middle = [0, 1].map(|k| (pair[0][k] + pair[1][k]) / 2.0);
        let off = 1000.0 - middle[0].hypot(middle[1]);
        assert!(off < 0.005, "{off} m at {middle:?}");
    }
}

#[test]
fn a_damaged_drawing_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.dxf");
    for text in ["", "not a drawing", "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nabc\n"] {
        std::fs::write(&file, text).unwrap();
        let unit = Some(LengthUnit::Metre);
        let drawing_file = DrawingFile { file: file.clone(), unit, layers: None };
        match read_drawing(&drawing_file, &SiteOrigin::default()) {
            Ok(read) => assert!(read.lines.is_empty(), "{text:?}"),
            Err(error) => {
                assert!(error.to_string().contains("bad.dxf: cannot be read"), "{error}")
            }
        }
    }
}

#[test]
fn a_drawing_of_too_many_objects_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("many.dxf");
    let message = |content: Vec<u8>| {
        std::fs::write(&file, content).unwrap();
        let unit = Some(LengthUnit::Metre);
        let drawing_file = DrawingFile { file: file.clone(), unit, layers: None };
        read_drawing(&drawing_file, &SiteOrigin::default()).unwrap_err().to_string()
    };
    let mut binary = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    binary.extend(b"\0\0POINT\0".repeat(400_001));
    for content in [
        b"0\nP\n".repeat(400_001),
        b" 00\r\nP\r\n".repeat(400_001),
        [&b"\xef\xbb\xbf999\nx\n"[..], &b"0\nP\n".repeat(400_001)].concat(),
        binary,
    ] {
        let error = message(content);
        assert!(error.contains("many.dxf: has 400001 objects, expected at most 400000"), "{error}");
    }
    // Values are no objects.
    let error = message(b"70\n0\n".repeat(400_001));
    assert!(error.contains("cannot be read as a DXF drawing"), "{error}");
    let error = message(b"AutoCAD DXB 1.0\r\n\x1a\0".to_vec());
    assert!(error.contains("it is a DXB file; save it as DXF"), "{error}");
}

/// Drawings of one unit whose program states that of its template.
#[test]
fn a_drawing_as_large_or_small_as_no_place_is_said() {
    let is_said = |units: Units, side: f64| {
        let mut drawing = dxf::Drawing::new();
        drawing.header.version = AcadVersion::R2010;
        drawing.header.default_drawing_units = units;
        drawing.add_entity(on("KERB", line([0.0, 0.0], [side, side / 2.0])));
        let (_folder, file) = saved(&drawing);
        let read = read_drawing(&file, &SiteOrigin::default()).unwrap();
        let notes = read.notes(std::path::Path::new("survey.dxf"));
        notes.iter().any(|note| note.contains("is that its unit"))
    };
    assert!(is_said(Units::Meters, 50_000.0), "millimetres that are said to be metres");
    assert!(is_said(Units::Inches, 50.0), "metres that are said to be inches");
    assert!(!is_said(Units::Meters, 50.0) && !is_said(Units::Millimeters, 50_000.0));
}
