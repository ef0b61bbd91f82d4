//! Draws the pictures of the README: the path of `square` with the errors of four laws, and precision against smoothness of all ten on
//! `square-compare`.
//!
//! `cargo run --release -p mm-benches --bin picture -- docs`

use std::error::Error;

use mm_control::LawKind;
use mm_sim::experiment::Experiment;
use mm_sim::scenario;
use mm_sim::simulation::{NoRecorder, Recorder, Sample};
use plotters::prelude::*;

const LAWS: [(&str, RGBColor); 4] = [
    ("bfsmc-thesis", RGBColor(230, 159, 0)),
    ("bsmc", RGBColor(150, 150, 150)),
    ("bsmc-sat", RGBColor(86, 180, 233)),
    ("bfsmc", RGBColor(0, 114, 178)),
];
const DESIRED: RGBColor = RGBColor(213, 94, 0);

/// What the picture needs of each sample.
#[derive(Default)]
struct Trace {
    time: Vec<f64>,
    desired: Vec<(f64, f64)>,
    tip: Vec<(f64, f64)>,
    base: Vec<(f64, f64)>,
    error_mm: Vec<f64>,
}

impl Recorder for Trace {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        let p = sample.reference.position;
        self.time.push(sample.t);
        self.desired.push((p.x, p.y));
        self.tip.push((sample.tip.x, sample.tip.y));
        self.base.push((sample.state.q.x, sample.state.q.y));
        self.error_mm.push((sample.tip - p).norm() * 1e3);
        Ok(true)
    }
}

fn trace(name: &str, law: &str) -> Result<Trace, Box<dyn Error>> {
    let sets = [format!("controller.kind=\"{law}\""), "simulation.log_rate_hz=50".to_owned()];
    let loaded = scenario::load(name, &sets)?;
    let mut trace = Trace::default();
    let Ok(_) = Experiment::build(&loaded)?.run(&mut trace);
    Ok(trace)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: picture FOLDER")?;
    let path = format!("{folder}/square.svg");
    let root = SVGBackend::new(&path, (960, 720)).into_drawing_area();
    root.fill(&WHITE)?;
    let (above, below) = root.split_vertically(330);
    draw_path(&above, &trace("square", "bfsmc")?)?;
    draw_errors(&below)?;
    root.present()?;
    let path = format!("{folder}/laws.svg");
    let root = SVGBackend::new(&path, (960, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    draw_laws(&root)?;
    root.present()?;
    Ok(())
}

/// Torque variation and ITAE of a law.
fn result(law: LawKind) -> Result<(f64, f64), Box<dyn Error>> {
    let loaded = scenario::load("square-compare", &[format!("controller.kind=\"{}\"", law.name())])?;
    let Ok(result) = Experiment::build(&loaded)?.run(&mut NoRecorder);
    Ok((result.metrics.torque_tv_n_m_per_s.sum, result.metrics.itae_m_s2.sum))
}

fn draw_laws(area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption("square-compare, ten laws tuned alike: precision against smoothness", ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d((10.0..300_000.0).log_scale(), (1e-4..30.0).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("torque variation (N m/s)")
        .y_desc("ITAE, sum over x, y, z (m s^2)")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(WHITE)
        .draw()?;
    for law in LawKind::ALL {
        let point = result(law)?;
        let color = if law == LawKind::Bfsmc { LAWS[3].1 } else { RGBColor(90, 90, 90) };
        // Two pairs of laws lie side by side.
        let up = if matches!(law, LawKind::Bsmc | LawKind::BsmcSat) { -20 } else { -4 };
        let label = EmptyElement::at(point)
            + Circle::new((0, 0), 5, color.filled())
            + Text::new(law.name(), (9, up), ("sans-serif", 14).into_font().color(&color));
        chart.draw_series(std::iter::once(label))?;
    }
    Ok(())
}

fn draw_path(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    run: &Trace,
) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption("square, bfsmc: 98 s seen from above", ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(-1.0..17.0, -2.0..3.7)?;
    chart.configure_mesh().x_desc("x (m)").y_desc("y (m)").light_line_style(WHITE).draw()?;
    let wide = |color: RGBColor, width| color.stroke_width(width);
    let series = [
        ("base (axle)", &run.base, wide(RGBColor(150, 150, 150), 2)),
        ("tip, desired", &run.desired, wide(DESIRED, 5)),
        ("tip", &run.tip, wide(RGBColor(0, 114, 178), 2)),
    ];
    for (name, points, style) in series {
        chart
            .draw_series(LineSeries::new(points.iter().copied(), style))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
    }
    legend(&mut chart, SeriesLabelPosition::Coordinate(275, 85))
}

fn draw_errors(area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption(
            "square-compare: tip error with 10 sin 2t N m on all joints from 10 to 60 s, masses + 25 %",
            ("sans-serif", 20),
        )
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..98.0, (1e-4..10.0).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("time (s)")
        .y_desc("distance from the reference (mm)")
        .y_label_formatter(&|mm| format!("{mm}"))
        .light_line_style(WHITE)
        .draw()?;
    for (law, color) in LAWS {
        let run = trace("square-compare", law)?;
        let points = run.time.iter().copied().zip(run.error_mm.iter().map(|e| e.max(1e-4)));
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(1)))?
            .label(law)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(3)));
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

fn legend<'a, X: Ranged<ValueType = f64>, Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
    position: SeriesLabelPosition,
) -> Result<(), Box<dyn Error>> {
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 15))
        .draw()?;
    Ok(())
}
