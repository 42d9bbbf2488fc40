//! The list of the panels: what each pane of the window is called and how it is drawn.

use egui::{Align2, Response, TextStyle, Ui, WidgetText, vec2};
use egui_tiles::{Behavior, SimplificationOptions, Tabs, Tile, TileId, Tiles, UiResponse};

use crate::app::looks::{self, Icon};
use crate::app::panels;
use crate::app::panes::{Pane, PaneContext};
use crate::app::state::Session;

/// Number of pane titles that the tab of a container shows before it ends in “…”.
const MAX_TITLES: usize = 2;

/// What a pane of the window shows.
pub struct Panel {
    /// The title of the pane.
    pub title: &'static str,
    /// The icon beside the title.
    pub icon: Icon,
    /// Draws the pane.
    ui: fn(&mut Ui, &mut PaneContext<'_>),
}

/// The panel of a pane.
pub fn panel(pane: Pane) -> Panel {
    let (title, icon, ui): (_, _, fn(&mut Ui, &mut PaneContext<'_>)) = match pane {
        Pane::Case => ("Contents", Icon::ListTree, panels::contents_ui),
        Pane::Data => ("Data", Icon::Database, panels::data_ui),
        Pane::Cases => ("Cases", Icon::Table2, panels::cases_ui),
        Pane::Vehicle => ("Vehicle", Icon::Car, panels::vehicle_ui),
        Pane::Scenario => ("Scenario", Icon::Zap, panels::scenario_ui),
        Pane::Scene => ("Scene", Icon::Map, panels::scene_ui),
        Pane::Motion => ("Motion", Icon::ChartLine, panels::motion_ui),
        Pane::Force => ("Force", Icon::Activity, panels::force_ui),
        Pane::Comparison => ("Comparison", Icon::GitCompare, panels::comparison_ui),
        Pane::ForcePrediction => ("Force prediction", Icon::ChartSpline, panels::prediction_ui),
        Pane::MotionForecast => ("Motion forecast", Icon::Route, panels::motion_forecast_ui),
        Pane::Evidence => ("Evidence", Icon::ClipboardList, panels::evidence_ui),
        Pane::ReconstructedScene => {
            ("Reconstructed scene", Icon::MapPin, panels::reconstructed_scene_ui)
        }
        Pane::Speeds => ("Speeds", Icon::Sigma, panels::speeds_ui),
        Pane::Hand => ("By hand", Icon::Calculator, panels::hand_ui),
        Pane::Replay => ("Replay", Icon::History, panels::replay_ui),
        Pane::Variants => ("Variants", Icon::Layers, panels::variants_ui),
        Pane::Models => ("Models", Icon::BrainCircuit, panels::models_ui),
        Pane::Training => ("Training", Icon::GraduationCap, panels::training_ui),
        Pane::Evaluation => ("Force evaluation", Icon::Gauge, panels::evaluation_ui),
        Pane::ModelComparison => ("Compare models", Icon::ChartBar, panels::model_comparison_ui),
        Pane::Report => ("Report", Icon::FileText, panels::report_ui),
        Pane::ReportPages => ("Report text", Icon::BookOpen, panels::report_pages_ui),
        Pane::AtlasChoices => ("Atlas", Icon::SlidersHorizontal, panels::atlas_choices_ui),
        Pane::AtlasMap => ("Map", Icon::Grid3x3, panels::atlas_map_ui),
        Pane::Sensitivity => ("What moves it", Icon::ChartBarDecreasing, panels::sensitivity_ui),
        Pane::Sweep => ("Sweep", Icon::Repeat, panels::sweep_ui),
    };
    Panel { title, icon, ui }
}

impl Behavior<Pane> for PaneContext<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let frame = egui::Frame::new().inner_margin(looks::MARGIN);
        let is_faded = pane.is_answer() && is_late(*pane, self.session);
        let draw = panel(*pane).ui;
        frame.show(ui, |ui| {
            // A field of another case has nothing of what was typed into this one.
            ui.push_id(self.session.n_cases, |ui| {
                panels::faded_if(ui, is_faded, |ui| draw(ui, self));
            });
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        panel(*pane).title.into()
    }

    /// Returns the title of a tab: that of its pane or, for a container, the titles of the first
    /// panes in it.
    fn tab_title_for_tile(&mut self, tiles: &Tiles<Pane>, tile_id: TileId) -> WidgetText {
        let mut names = Vec::new();
        collect_titles(tiles, tile_id, &mut names);
        let more = if names.len() > MAX_TITLES { ", …" } else { "" };
        names.truncate(MAX_TITLES);
        format!("{}{more}", names.join(", ")).into()
    }

    /// Says that an answer which is shown is not of what is asked any more: beside the tabs, where it lies
    /// over nothing.
    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<Pane>,
        ui: &mut Ui,
        _: TileId,
        tabs: &Tabs,
        _: &mut f32,
    ) {
        let shown = tabs.active.and_then(|active| tiles.get(active));
        if let Some(Tile::Pane(pane)) = shown
            && is_late(*pane, self.session)
        {
            ui.add_space(looks::GRID);
            ui.label("computing…");
        }
    }

    /// A tab for which there is no room ends in “…”, and says its whole title on hovering.
    fn on_tab_button(
        &mut self,
        tiles: &mut Tiles<Pane>,
        tile_id: TileId,
        button: Response,
    ) -> Response {
        let mut names = Vec::new();
        collect_titles(tiles, tile_id, &mut names);
        let (whole, seen) = (button.rect, button.interact_rect);
        if seen.is_positive() && whole.right() > seen.right() + 1.0 {
            end_in_dots(&button);
        }
        match names.len() > MAX_TITLES || !seen.expand(1.0).contains_rect(whole) {
            true => button.on_hover_text(names.join(", ")),
            false => button,
        }
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}

/// Whether what a pane shows is not of what is asked any more, for so long that a person sees it.
fn is_late(pane: Pane, session: &Session) -> bool {
    match pane {
        Pane::ForcePrediction => session.force.forecast.is_late(),
        Pane::MotionForecast => session.is_motion_late(),
        Pane::Hand => session.hand.is_late(),
        pane => pane.is_answer() && session.is_simulation_late(),
    }
}

/// Draws “…” at the right end of what is seen of a tab.
fn end_in_dots(button: &Response) {
    let style = button.ctx.global_style();
    let color = style.visuals.text_color();
    let painter = button.ctx.layer_painter(button.layer_id).with_clip_rect(button.interact_rect);
    let font = TextStyle::Button.resolve(&style);
    let dots = painter.layout_no_wrap("…".to_owned(), font, color);
    let end = button.interact_rect.right_center();
    let place = Align2::RIGHT_CENTER.anchor_size(end, dots.size());
    painter.rect_filled(place.expand2(vec2(2.0, 0.0)), 0.0, style.visuals.panel_fill);
    painter.galley(place.min, dots, color);
}

/// Collects the titles of the panes in a tile, in their order.
fn collect_titles(tiles: &Tiles<Pane>, tile_id: TileId, titles: &mut Vec<&'static str>) {
    match tiles.get(tile_id) {
        Some(Tile::Pane(pane)) => titles.push(panel(*pane).title),
        Some(Tile::Container(container)) => {
            for child in container.children() {
                collect_titles(tiles, *child, titles);
            }
        }
        None => {}
    }
}
