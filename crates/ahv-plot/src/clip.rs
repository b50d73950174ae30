//! Lines cut at the border of a panel.

use crate::extent::Extent;

type Point = (f64, f64);

/// The parts of the line through `points` (scaled) that lie inside, each unbroken.
pub(crate) fn inside(points: &[Point], x: &Extent, y: &Extent) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in points.windows(2) {
        let &[from, to] = pair else { continue };
        let Some((start, end)) = segment(from, to, x, y) else {
            continue;
        };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&start) => part.push(end),
            _ => parts.push(vec![start, end]),
        }
    }
    parts
}

/// The part of a segment inside the rectangle (Liang and Barsky 1984).
fn segment(from: Point, to: Point, x: &Extent, y: &Extent) -> Option<(Point, Point)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, room) in [
        (-dx, from.0 - x.min),
        (dx, x.max - from.0),
        (-dy, from.1 - y.min),
        (dy, y.max - from.1),
    ] {
        if step == 0.0 && room < 0.0 {
            return None;
        } else if step < 0.0 {
            enter = enter.max(room / step);
        } else if step > 0.0 {
            leave = leave.min(room / step);
        }
    }
    // Whole segments keep their ends to the bit, so that neighbours join.
    let at = |t: f64| match t {
        0.0 => from,
        1.0 => to,
        _ => (from.0 + t * dx, from.1 + t * dy),
    };
    (enter <= leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests {
    use super::inside;
    use crate::Scale;
    use crate::extent::Extent;

    #[test]
    fn a_line_is_cut_where_it_leaves() {
        let extent = Extent {
            scale: Scale::Linear,
            min: 0.0,
            max: 1.0,
            named: false,
        };
        let zigzag = [(0.0, 0.5), (0.5, 1.5), (1.0, 0.5), (2.0, 0.5)];
        let parts = inside(&zigzag, &extent, &extent);
        let expected = [
            vec![(0.0, 0.5), (0.25, 1.0)],
            vec![(0.75, 1.0), (1.0, 0.5), (1.0, 0.5)],
        ];
        assert_eq!(parts, expected);
        assert!(inside(&[(-1.0, 2.0), (3.0, 2.0)], &extent, &extent).is_empty());
    }
}
