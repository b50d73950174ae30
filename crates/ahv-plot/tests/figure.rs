//! Figures as SVG text.
#![forbid(unsafe_code)]

use ahv_plot::{Axis, Cells, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};

fn panel(layers: Vec<Layer>) -> Panel {
    Panel {
        title: "decay <of> a mode".to_owned(),
        x: Axis::linear("time [s]"),
        y: Axis::linear("η [(ft·slug)^½]"),
        layers,
    }
}

fn curve(points: Vec<(f64, f64)>) -> Layer {
    Layer::new("exact", Colour::Blue, Mark::Line(points))
}

/// One panel with every kind of layer but cells, and one with cells.
fn everything() -> Figure {
    let wave = |i: i32| (f64::from(i) / 50.0, (f64::from(i) / 8.0).sin());
    let line: Vec<_> = (0..=100).map(wave).collect();
    let band = line.iter().map(|&(x, y)| (x, y - 0.2, y + 0.2)).collect();
    let shapes = [
        Shape::Circle,
        Shape::Dot,
        Shape::Cross,
        Shape::Plus,
        Shape::Square,
        Shape::Diamond,
    ];
    let mut layers = vec![
        Layer::new("95 %", Colour::Blue, Mark::Band(band)),
        curve(line.clone()),
        Layer::new(
            "reduced",
            Colour::Vermillion,
            Mark::Line(vec![(0.0, 1.0), (2.0, -1.0)]),
        )
        .dashed(),
        Layer::new("", Colour::Grey, Mark::HorizontalRule(0.0)).dashed(),
        Layer::new("", Colour::Grey, Mark::VerticalRule(1.0)),
        Layer::new(
            "counts",
            Colour::Green,
            Mark::Bars {
                edges: vec![0.0, 0.5, 1.0, 1.5],
                heights: vec![0.3, 0.9, 0.5],
            },
        ),
    ];
    for (index, shape) in shapes.into_iter().enumerate() {
        let name = format!("{shape:?}");
        let at = (0.2 + 0.3 * index as f64, -0.8);
        layers.push(Layer::new(
            name,
            Colour::CYCLE[index],
            Mark::Markers(shape, vec![at]),
        ));
    }
    let edges = |n: i32| (0..=n).map(f64::from).collect::<Vec<_>>();
    let values = (0..12).map(|i| (i != 5).then_some(f64::from(i)));
    let map = Cells {
        x: edges(4),
        y: edges(3),
        values: values.collect(),
        label: "α [deg]".to_owned(),
    };
    let map = panel(vec![Layer::new("", Colour::Black, Mark::Cells(map))]);
    let log = Panel {
        x: Axis::log("frequency [rad/s]"),
        y: Axis::log("spectrum [ft·slug·s]").within(1e-3, 10.0),
        ..panel(vec![curve(vec![(0.1, 5.0), (10.0, 4.0), (1000.0, 1e-5)])])
    };
    Figure::new("Everything", 2, vec![panel(layers), map, log])
}

#[test]
fn text_stays_text_and_the_file_refers_to_nothing() {
    let svg = everything().svg().expect("drawn");
    if let Some(path) = std::env::var_os("AHV_PLOT_LOOK") {
        std::fs::write(path, &svg).expect("written");
    }
    assert!(svg.starts_with("<svg width=\"1000\" height="));
    assert!(svg.trim_end().ends_with("</svg>"));
    for text in [
        "time [s]",
        "decay &lt;of&gt; a mode",
        "Everything",
        "10⁻²",
        "α [deg]",
    ] {
        assert!(svg.contains(text), "{text} is missing");
    }
    assert!(!svg.contains("href") && !svg.contains("url(") && !svg.contains("NaN"));
    // Both panels show it, the legend once.
    assert_eq!(svg.matches("exact").count(), 1);
    assert_eq!(svg, everything().svg().expect("drawn again"));
}

#[test]
fn a_line_beyond_the_range_is_cut_at_the_border() {
    let within = |max: f64| {
        let panel = Panel {
            y: Axis::linear("y").within(0.0, 1.0),
            x: Axis::linear("x").within(0.0, 1.0),
            ..panel(vec![curve(vec![(0.0, 0.5), (max, 0.5)])])
        };
        Figure::new("", 1, vec![panel]).svg().expect("drawn")
    };
    assert_eq!(within(1.0), within(50.0));
    assert_ne!(within(1.0), within(0.5));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let draw = |panel: Panel| Figure::new("f", 1, vec![panel]).svg().expect_err("refused");
    let error = draw(panel(vec![curve(vec![(0.0, 1.0), (1.0, f64::NAN)])]));
    assert!(
        matches!(&error, PlotError::NonFinite { layer, .. } if layer == "exact"),
        "{error}"
    );
    let log = Panel {
        y: Axis::log("y"),
        ..panel(vec![curve(vec![(0.0, 1.0), (1.0, 0.0)])])
    };
    assert!(matches!(
        draw(log),
        PlotError::NotPositive { value: 0.0, .. }
    ));
    assert!(matches!(draw(panel(vec![])), PlotError::NoRange { .. }));
    let backwards = Panel {
        x: Axis::linear("x").within(1.0, 0.0),
        ..panel(vec![curve(vec![(0.0, 1.0)])])
    };
    assert!(matches!(draw(backwards), PlotError::BadRange { .. }));
    let bars = Mark::Bars {
        edges: vec![0.0, 1.0],
        heights: vec![],
    };
    let bars = panel(vec![Layer::new("bars", Colour::Blue, bars)]);
    assert!(matches!(
        draw(bars),
        PlotError::Length {
            expected: 1,
            found: 0,
            ..
        }
    ));
    let none = Figure::new("f", 1, vec![]).svg();
    assert!(matches!(none, Err(PlotError::NoPanels { .. })));
    // A constant is drawn with an axis around it.
    let constant = panel(vec![curve(vec![(0.0, 2.0), (1.0, 2.0)])]);
    assert!(Figure::new("", 1, vec![constant]).svg().is_ok());
}

#[test]
fn a_panel_without_data_does_not_hide_the_others() {
    let empty = Panel {
        title: "distribution".to_owned(),
        ..panel(vec![curve(vec![])])
    };
    let full = panel(vec![curve(vec![(0.0, 1.0), (1.0, 2.0)])]);
    let svg = Figure::new("", 2, vec![full, empty.clone()])
        .svg()
        .expect("drawn");
    assert!(svg.contains("distribution: no data") && svg.contains("decay"));
    let alone = Figure::new("", 2, vec![empty]).svg();
    assert!(matches!(alone, Err(PlotError::NoRange { .. })));
}

/// Neither an error nor a number that is none, whatever finite numbers there are.
#[test]
fn extreme_numbers_are_drawn_or_refused() {
    for size in [
        f64::MIN_POSITIVE,
        5e-324,
        1e-308,
        1e-9,
        1e9,
        1e300,
        f64::MAX,
    ] {
        for points in [
            vec![(0.0, size), (1.0, size)],
            vec![(0.0, 0.0), (size, size)],
            vec![(0.0, -size), (1.0, size)],
        ] {
            let cells = Cells {
                x: vec![0.0, 1.0, 2.0],
                y: vec![0.0, 1.0],
                values: points.iter().map(|point| Some(point.1)).collect(),
                label: "cells".to_owned(),
            };
            let log = Panel {
                y: Axis::log("y"),
                ..panel(vec![curve(vec![(0.0, 1.0), (1.0, size)])])
            };
            let cells = panel(vec![Layer::new("", Colour::Black, Mark::Cells(cells))]);
            for panel in [panel(vec![curve(points)]), cells, log] {
                match Figure::new("", 1, vec![panel]).svg() {
                    Ok(svg) => assert!(!svg.contains("NaN") && !svg.contains("inf"), "{size:?}"),
                    Err(error) => assert!(matches!(error, PlotError::BadRange { .. }), "{error}"),
                }
            }
        }
    }
}

#[test]
fn rows_have_names_from_the_top() {
    let bar = |row: f64, length| vec![(0.0, row - 0.3, row + 0.3), (length, row - 0.3, row + 0.3)];
    let bars = [bar(0.0, 3.0), bar(-1.0, 2.0)];
    let layers = bars.map(|bar| Layer::new("", Colour::Blue, Mark::Band(bar)));
    let rows = Panel {
        y: Axis::rows(vec!["first".to_owned(), "second".to_owned()]),
        ..panel(layers.to_vec())
    };
    let svg = Figure::new("", 1, vec![rows]).svg().expect("a picture");
    let place = |name: &str| -> f64 {
        let before = svg.split(&format!("\n{name}\n")).next().expect("text");
        let y = before.rsplit(" y=\"").next().expect("a place");
        y.split('"')
            .next()
            .and_then(|y| y.parse().ok())
            .expect("a number")
    };
    assert!(svg.contains("second") && place("first") < place("second"));
}
