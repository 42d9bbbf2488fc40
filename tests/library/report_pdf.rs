//! PDF of reports: pages, fonts, tags and text as other programs read them.

use std::path::Path;

use impactlab_core::units::UnitSystem;
use impactlab_document::report::{Drawn, Language, Medium, Paper, PictureContent, Pixels, pdf};
use impactlab_study::case_file::CaseFile;

use crate::report::{impact_case, pit, report, settings};
use crate::report_german::german_example;

/// Draws any figure as a gray field.
pub fn gray(_: &PictureContent, _: Medium) -> Result<Drawn, String> {
    Ok(Drawn::Pixels(Pixels { size_px: [16, 9], rgba: [128, 128, 128, 255].repeat(16 * 9) }))
}

#[test]
fn the_pdf_is_read_back_with_its_pages_fonts_tags_and_text() {
    let (document, _) = pit();
    let bytes = pdf(document, Some(&gray)).expect("a PDF");
    let read = lopdf::Document::load_mem(&bytes).expect("readable");
    let pages = read.get_pages();
    // An opinion of two pages and an annex of sixteen.
    assert!((8..=18).contains(&pages.len()), "{} pages", pages.len());
    let catalog = read.catalog().expect("a catalog");
    for key in ["StructTreeRoot", "MarkInfo", "Outlines", "Lang"] {
        assert!(catalog.has(key.as_bytes()), "the catalog has no {key}");
    }
    let fonts = read.objects.values().filter_map(|object| object.as_dict().ok());
    let described = fonts.filter(|font| {
        font.get(b"Type").and_then(|of| of.as_name()).is_ok_and(|name| name == b"FontDescriptor")
    });
    let mut n_fonts = 0;
    for font in described {
        n_fonts += 1;
        assert!(font.has(b"FontFile2") || font.has(b"FontFile3"), "a font is not embedded");
    }
    assert!(n_fonts > 0);
    let numbers: Vec<u32> = pages.keys().copied().collect();
    let text: String =
        numbers.iter().map(|page| read.extract_text(&[*page]).expect("text")).collect();
    let joined: String = text.split_whitespace().collect();
    for wanted in ["Questionsandanswers", "Page1of", "impulseonthestruckvehicle", "Kudlich", "Δv"]
    {
        assert!(joined.contains(wanted), "{wanted} cannot be extracted");
    }
}

/// The English report of the example has 18 pages; German words may take two more.
#[test]
fn neither_german_nor_other_units_make_the_report_longer() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples/pit.impactlab");
    let case = CaseFile::load(&path).expect("a case");
    let (american, _) = report(&case, &settings(Language::En, UnitSystem::Us, Paper::A4));
    for (what, document) in [("German", german_example()), ("US units", &american)] {
        let bytes = pdf(document, Some(&gray)).expect("a PDF");
        let read = lopdf::Document::load_mem(&bytes).expect("readable");
        let n_pages = read.get_pages().len();
        assert!(n_pages <= 20, "{what}: {n_pages} pages");
    }
}

#[test]
fn pages_have_the_size_of_the_paper() {
    for (paper, size) in [(Paper::A4, [595.276, 841.89]), (Paper::Letter, [612.0, 792.0])] {
        let case = impact_case("size", "");
        let (document, _) = report(&case, &settings(Language::En, UnitSystem::Si, paper));
        let bytes = pdf(&document, None).expect("a PDF");
        let read = lopdf::Document::load_mem(&bytes).expect("readable");
        for id in read.get_pages().values() {
            let page = read.get_dictionary(*id).expect("a page");
            let media = page.get(b"MediaBox").and_then(|of| of.as_array()).expect("a box");
            let ends = [&media[2], &media[3]].map(|of| of.as_float().expect("a number"));
            for (end, expected) in ends.into_iter().zip(size) {
                assert!((end - expected).abs() < 0.01, "{paper:?}: {end} {expected}");
            }
        }
    }
}
