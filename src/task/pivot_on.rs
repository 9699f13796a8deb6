//! Lines and points on which the fixed pivots are to lie.

use crate::mechanism::{Complex, dot, point};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A straight line through two points, without ends; or a point, given by itself or twice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Locus(pub Vec<[f64; 2]>);

impl Locus {
    /// Returns the first point and the direction of the line, of length 1; `None` of a point.
    pub fn line(&self) -> Option<(Complex, Complex)> {
        let [from, to] = *self.0.as_slice() else { return None };
        let along = point(to) - point(from);
        (from != to).then(|| (point(from), along / along.norm()))
    }

    /// Returns the only value of each coordinate that it allows: both of a point, one of a line along an axis.
    pub fn fixed(&self) -> [Option<f64>; 2] {
        let Some(first) = self.0.first() else { return [None; 2] };
        [0, 1].map(|axis| self.0.iter().all(|place| place[axis] == first[axis]).then_some(first[axis]))
    }

    /// Returns whether it is a line that runs along neither axis.
    pub fn is_slanted(&self) -> bool {
        self.fixed() == [None; 2]
    }

    /// Returns the directions across it, of length 1, in which its places have one and the same coordinate: of a line one, of a
    /// point both axes.
    pub fn normals(&self) -> Vec<Complex> {
        match self.line() {
            Some((_, along)) => vec![Complex::new(-along.im, along.re)],
            None => vec![Complex::new(1.0, 0.0), Complex::new(0.0, 1.0)],
        }
    }

    /// Returns a place of it.
    pub fn first(&self) -> Complex {
        self.0.first().map_or(Complex::new(0.0, 0.0), |place| point(*place))
    }

    /// Returns the nearest place of it.
    pub fn nearest(&self, place: Complex) -> Complex {
        match self.line() {
            Some((from, along)) => from + along * dot(along, place - from),
            None => self.first(),
        }
    }

    /// Returns whether a box [xmin, ymin, xmax, ymax] holds a place of it.
    pub fn meets(&self, [x0, y0, x1, y1]: [f64; 4]) -> bool {
        let normals = self.normals();
        let corners = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]].map(|corner| point(corner) - self.first());
        normals.iter().all(|normal| {
            let off = corners.map(|corner| dot(*normal, corner));
            off.iter().any(|off| *off <= 0.0) && off.iter().any(|off| *off >= 0.0)
        })
    }
}

/// The lines or points on which the fixed pivots are to lie.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PivotOn {
    /// That of the crank's pivot A; absent: anywhere.
    #[serde(rename = "A", default, skip_serializing_if = "Option::is_none")]
    pub crank_pivot: Option<Locus>,
    /// That of the follower's pivot B; absent: anywhere.
    #[serde(rename = "B", default, skip_serializing_if = "Option::is_none")]
    pub follower_pivot: Option<Locus>,
}

impl PivotOn {
    /// Returns that of A and that of B.
    pub fn both(&self) -> [Option<&Locus>; 2] {
        [self.crank_pivot.as_ref(), self.follower_pivot.as_ref()]
    }

    /// Returns the coordinates of all their points.
    pub fn points(&self) -> impl Iterator<Item = &[f64; 2]> {
        self.both().into_iter().flatten().flat_map(|locus| &locus.0)
    }

    /// As [`PivotOn::points`], to change them.
    pub fn points_mut(&mut self) -> impl Iterator<Item = &mut [f64; 2]> {
        let both = [&mut self.crank_pivot, &mut self.follower_pivot];
        both.into_iter().flatten().flat_map(|locus| &mut locus.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_place_lies_on_the_line_and_a_box_meets_what_it_holds() {
        let line = Locus(vec![[1.0, 1.0], [4.0, 5.0]]);
        let place = Complex::new(-3.0, 2.0);
        let nearest = line.nearest(place);
        let along = Complex::new(3.0, 4.0) / 5.0;
        assert!(dot(along, place - nearest).abs() < 1e-14);
        assert!(dot(line.normals()[0], nearest - line.first()).abs() < 1e-14);
        assert!(line.is_slanted() && line.meets([2.0, 2.0, 3.0, 4.0]) && !line.meets([2.0, 0.0, 5.0, 1.5]));
        let level = Locus(vec![[1.0, 2.0], [4.0, 2.0]]);
        assert_eq!(level.fixed(), [None, Some(2.0)]);
        assert!(
            !level.is_slanted() && level.meets([9.0, 1.0, 11.0, 2.0]) && !level.meets([1.0, 3.0, 4.0, 4.0])
        );
        for point in [Locus(vec![[1.0, 2.0]]), Locus(vec![[1.0, 2.0]; 2])] {
            assert_eq!(point.fixed(), [Some(1.0), Some(2.0)]);
            assert_eq!((point.line(), point.nearest(place)), (None, Complex::new(1.0, 2.0)));
            assert!(point.meets([0.0, 0.0, 1.0, 2.0]) && !point.meets([0.0, 0.0, 0.9, 2.0]));
        }
    }
}
