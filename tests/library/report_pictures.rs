//! The pictures of a report: lines and letters on a page, pixels elsewhere.

use impactlab_document::report::{
    Drawn, Medium, PictureContent, ReportFormat, VectorMark, VectorPicture, VectorShape, pdf,
};

use crate::report::pit;
use crate::report_pdf::gray;

/// Draws a plot as an area with a word on it, and a scene as a gray field.
fn lettered(content: &PictureContent, medium: Medium) -> Result<Drawn, String> {
    if !content.is_plot() || medium == Medium::Screen {
        return gray(content, medium);
    }
    let corners = vec![[10.0, 10.0], [90.0, 10.0], [50.0, 70.0]];
    let area = VectorShape::Outline {
        contours: vec![corners],
        is_closed: true,
        fill: Some([0, 114, 178, 90]),
        stroke: Some((1.5, [0, 114, 178, 255])),
    };
    let word = VectorShape::Text {
        at: [20.0, 60.0],
        angle_rad: -1.5,
        size: 9.0,
        color: [0, 0, 0, 255],
        text: "Zeitachse".to_owned(),
    };
    let clip = [0.0, 0.0, 100.0, 75.0];
    let marks = [area, word].map(|shape| VectorMark { clip, shape }).to_vec();
    Ok(Drawn::Vectors(VectorPicture { size: [100.0, 75.0], marks }))
}

/// Plots were pixels, which blur where a page is enlarged.
#[test]
fn plots_are_lines_and_letters_in_the_pdf() {
    let (document, _) = pit();
    let n_plots = document.pictures().filter(|picture| picture.content.is_plot()).count();
    assert!(n_plots > 5, "{n_plots}");
    let bytes = pdf(document, Some(&lettered)).expect("a PDF");
    let read = lopdf::Document::load_mem(&bytes).expect("readable");
    let numbers: Vec<u32> = read.get_pages().keys().copied().collect();
    let text: String =
        numbers.iter().map(|page| read.extract_text(&[*page]).expect("text")).collect();
    let joined: String = text.split_whitespace().collect();
    assert_eq!(joined.matches("Zeitachse").count(), n_plots);
    let markdown = document.bytes(ReportFormat::Markdown, Some(&lettered)).expect("Markdown");
    let text = String::from_utf8(markdown).expect("a text");
    assert!(text.matches("data:image/png").count() >= n_plots);
}

#[test]
fn markdown_holds_its_pictures() {
    let (document, _) = pit();
    let bytes = document.bytes(ReportFormat::Markdown, Some(&gray)).expect("Markdown");
    let text = String::from_utf8(bytes).expect("a text");
    for picture in document.pictures() {
        let name = format!("[figure-{}]", picture.number);
        assert_eq!(text.matches(&name).count(), 2, "{name} stands once and is told once");
    }
    // The first bytes of a PNG file.
    let start = "data:image/png;base64,iVBORw0KGgo";
    assert_eq!(text.matches(start).count(), document.pictures().count());
    let told = document.bytes(ReportFormat::Markdown, None).expect("Markdown");
    assert!(!String::from_utf8(told).expect("a text").contains("base64"));
}
