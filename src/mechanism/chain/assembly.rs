//! Assembly of a chain from its named parts: every point's name resolved once, every part checked.

use super::builder::{ChainBuilder, MAX_POINT_NAME, MAX_STAGES};
use super::coincident_sq;
use super::{Attachment, Chain, ChainError, ChainFault, ChainPlace, Line, PointId, SliderLine, Stage, Step};
use crate::mechanism::four_bar::coupler_ratio;
use crate::mechanism::{Complex, CouplerSide, LinkageError, MAX_MAGNITUDE, point};
use std::collections::HashMap;

/// The points of a link with their places in the link's own frame.
type Link = Vec<(usize, Complex)>;

/// A chain that is being assembled.
pub(super) struct Assembly<'a> {
    source: &'a ChainBuilder,
    names: Vec<String>,
    known: HashMap<String, usize>,
    links: Vec<Link>,
    /// For each point the indices of the links that carry it.
    links_of: Vec<Vec<usize>>,
    /// The largest coordinate or length.
    scale: f64,
    steps: Vec<Step>,
}

/// The part of the chain, and the point that it makes, to which an error is attributed.
struct Site<'a> {
    place: ChainPlace,
    joint: &'a str,
}

/// A key of a part, with an index if its value is a list.
#[derive(Clone, Copy)]
struct Key<'a> {
    site: &'a Site<'a>,
    key: &'static str,
    index: Option<usize>,
}

/// The outcome of a step of the assembly.
type Assembled<T> = Result<T, Box<ChainError>>;

impl Site<'_> {
    fn key(&self, key: &'static str) -> Key<'_> {
        Key { site: self, key, index: None }
    }
}

impl Key<'_> {
    fn nth(self, index: usize) -> Self {
        Key { index: Some(index), ..self }
    }

    fn error(self, fault: ChainFault) -> Box<ChainError> {
        let Key { site: Site { place, joint }, key, index } = self;
        Box::new(ChainError { place: place.clone(), joint: (*joint).to_owned(), key, index, fault })
    }
}

/// Returns whether a number is finite and not too large; false for NaN.
fn is_usable(value: f64) -> bool {
    value.abs() <= MAX_MAGNITUDE
}

const ZERO: Complex = Complex::new(0.0, 0.0);

impl<'a> Assembly<'a> {
    pub(super) fn new(source: &'a ChainBuilder) -> Self {
        Assembly {
            source,
            names: Vec::new(),
            known: HashMap::new(),
            links: vec![Link::new()],
            links_of: Vec::new(),
            scale: 0.0,
            steps: Vec::new(),
        }
    }

    /// Assembles the chain, without its source.
    pub(super) fn finish(mut self) -> Assembled<Chain> {
        let source = self.source;
        let whole = Site { place: ChainPlace::Chain, joint: "" };
        if source.stages.len() > MAX_STAGES {
            return Err(whole.key("dyad").error(ChainFault::TooManyStages(source.stages.len())));
        }
        for (name, at) in &source.pivots {
            let site = Site { place: ChainPlace::Pivot(name.clone()), joint: name };
            self.numbers(site.key("pivots"), at)?;
            let id = self.name(site.key("pivots"), name)?;
            self.attach(0, id, point(*at));
        }
        let site = Site { place: ChainPlace::Crank, joint: &source.crank_joint };
        let pivots = self.names.clone();
        let Some(&crank_pivot) = self.known.get(&source.crank_pivot) else {
            let fault = ChainFault::NotAPivot { name: source.crank_pivot.clone(), known: pivots };
            return Err(site.key("pivot").error(fault));
        };
        self.length(site.key("length"), source.crank)?;
        let joint = self.name(site.key("joint"), &source.crank_joint)?;
        self.link(crank_pivot, joint, Complex::new(source.crank, 0.0));
        for (i, stage) in source.stages.iter().enumerate() {
            let site = Site { place: ChainPlace::Stage(i), joint: stage.joint() };
            let step = self.stage(&site, stage)?;
            self.steps.push(step);
        }
        let trace = match &source.trace {
            Some(name) => self.find(whole.key("trace"), name)?,
            None => self.names.len() - 1,
        };
        let as_ids = |link: &Link| link.iter().map(|(i, _)| PointId(*i)).collect();
        Ok(Chain {
            pivots: source.pivots.iter().map(|(_, at)| point(*at)).collect(),
            crank_pivot,
            crank: source.crank,
            trace,
            links: self.links.iter().map(as_ids).collect(),
            places: self.links.iter().map(|link| link.iter().map(|(_, place)| *place).collect()).collect(),
            coincident_sq: coincident_sq(self.scale),
            names: self.names,
            steps: self.steps,
            source: ChainBuilder::default(),
        })
    }

    fn stage(&mut self, site: &Site<'_>, stage: &Stage) -> Assembled<Step> {
        match stage {
            Stage::Dyad { joint, from, lengths: [b, c], side } => {
                let [p, q] = self.two(site.key("from"), from)?;
                self.length(site.key("lengths").nth(0), *b)?;
                self.length(site.key("lengths").nth(1), *c)?;
                let n = self.name(site.key("joint"), joint)?;
                self.link(p, n, Complex::new(*b, 0.0));
                self.link(q, n, Complex::new(*c, 0.0));
                Ok(Step::Dyad {
                    p,
                    q,
                    radius_sq: b * b,
                    half_difference: 0.5 * (b * b - c * c),
                    sine_per_cross: 1.0 / (b * c),
                    t: side.sign(),
                })
            }
            Stage::Point { name, on, at } => {
                let [p, q] = self.two(site.key("on"), on)?;
                let (link, [from, to]) = self.common_link(site.key("on"), on, [p, q])?;
                let base = (to - from).norm();
                let offset = match *at {
                    Attachment::Offset(offset) => {
                        self.numbers(site.key("at"), &offset)?;
                        point(offset)
                    }
                    Attachment::Distances(distances, side) => {
                        self.numbers(site.key("distances"), &distances)?;
                        offset_from_distances(site, on, base, distances, side)?
                    }
                };
                let z = offset / base;
                let n = self.name(site.key("name"), name)?;
                self.attach(link, n, from + z * (to - from));
                Ok(Step::Point { p, q, z })
            }
            Stage::Slider { joint, from, length, line, side } => {
                let p = self.find(site.key("from"), from)?;
                self.length(site.key("length"), *length)?;
                let line = self.line(site, line)?;
                let n = self.name(site.key("joint"), joint)?;
                self.link(p, n, Complex::new(*length, 0.0));
                Ok(Step::Slider { p, length_sq: length * length, line, t: side.sign() })
            }
            Stage::Guide { joint, pivot, block, at, offset, side } => {
                let p = self.find(site.key("pivot"), pivot)?;
                let q = self.find(site.key("block"), block)?;
                if p == q {
                    return Err(site.key("block").error(ChainFault::SamePoint(block.clone())));
                }
                self.numbers(site.key("at"), at)?;
                self.number(site.key("offset"), *offset)?;
                if *at == [0.0, 0.0] {
                    return Err(site.key("at").error(ChainFault::NoLength));
                }
                let n = self.name(site.key("joint"), joint)?;
                self.link(p, n, point(*at));
                Ok(Step::Guide { p, q, w: point(*at), offset: *offset, t: side.sign() })
            }
        }
    }

    fn line(&mut self, site: &Site<'_>, line: &SliderLine) -> Assembled<Line> {
        match line {
            SliderLine::Fixed { through, angle } => {
                self.numbers(site.key("through"), through)?;
                if !is_usable(*angle) {
                    return Err(site.key("angle_deg").error(ChainFault::NotFinite(*angle)));
                }
                Ok(Line::Fixed { origin: point(*through), direction: Complex::from_polar(1.0, *angle) })
            }
            SliderLine::OnLink { along, offset } => {
                let [p, q] = self.two(site.key("along"), along)?;
                self.number(site.key("offset"), *offset)?;
                let (_, [from, to]) = self.common_link(site.key("along"), along, [p, q])?;
                Ok(Line::OnLink { p, q, per_length: 1.0 / (to - from).norm(), offset: *offset })
            }
        }
    }

    /// Adds a new point and returns its index.
    fn name(&mut self, key: Key<'_>, name: &str) -> Assembled<usize> {
        let allowed = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
        if name.is_empty() || name.chars().count() > MAX_POINT_NAME || !name.chars().all(allowed) {
            return Err(key.error(ChainFault::BadName(name.to_owned())));
        }
        let id = self.names.len();
        if self.known.insert(name.to_owned(), id).is_some() {
            return Err(key.error(ChainFault::DuplicateName(name.to_owned())));
        }
        self.names.push(name.to_owned());
        self.links_of.push(Vec::new());
        Ok(id)
    }

    /// Returns the index of a point that is known already.
    fn find(&self, key: Key<'_>, name: &str) -> Assembled<usize> {
        if let Some(&id) = self.known.get(name) {
            return Ok(id);
        }
        let known = self.source.all_names();
        let name = name.to_owned();
        Err(key.error(if known.contains(&name) {
            ChainFault::ForwardReference { itself: key.site.joint == name, name }
        } else {
            ChainFault::UnknownPoint { name, known }
        }))
    }

    /// Returns the indices of two different points that are known already.
    fn two(&self, key: Key<'_>, [first, second]: &[String; 2]) -> Assembled<[usize; 2]> {
        let p = self.find(key.nth(0), first)?;
        let q = self.find(key.nth(1), second)?;
        if p == q {
            return Err(key.nth(1).error(ChainFault::SamePoint(second.clone())));
        }
        Ok([p, q])
    }

    /// Returns a link that carries two points, and their positions on it.
    fn common_link(
        &self,
        key: Key<'_>,
        [first, second]: &[String; 2],
        [p, q]: [usize; 2],
    ) -> Assembled<(usize, [Complex; 2])> {
        let Some(&link) = self.links_of[p].iter().find(|l| self.links_of[q].contains(l)) else {
            return Err(key.error(ChainFault::NotOnOneLink(first.clone(), second.clone())));
        };
        let place = |of: usize| self.links[link].iter().find(|(i, _)| *i == of).map_or(ZERO, |(_, z)| *z);
        let [from, to] = [place(p), place(q)];
        if (to - from).norm_sqr() <= coincident_sq(self.scale) {
            return Err(key.error(ChainFault::Coincident(first.clone(), second.clone())));
        }
        Ok((link, [from, to]))
    }

    fn attach(&mut self, link: usize, id: usize, at: Complex) {
        self.links[link].push((id, at));
        self.links_of[id].push(link);
    }

    /// Adds a new link from one point to another, which lies at `at` in its frame.
    fn link(&mut self, from: usize, to: usize, at: Complex) {
        self.links.push(Link::new());
        let link = self.links.len() - 1;
        self.attach(link, from, ZERO);
        self.attach(link, to, at);
    }

    fn number(&mut self, key: Key<'_>, value: f64) -> Assembled<()> {
        if !is_usable(value) {
            return Err(key.error(ChainFault::NotFinite(value)));
        }
        self.scale = self.scale.max(value.abs());
        Ok(())
    }

    fn numbers(&mut self, key: Key<'_>, values: &[f64; 2]) -> Assembled<()> {
        (0..2).try_for_each(|i| self.number(key.nth(i), values[i]))
    }

    fn length(&mut self, key: Key<'_>, value: f64) -> Assembled<()> {
        self.number(key, value)?;
        if value <= 0.0 {
            return Err(key.error(ChainFault::LengthNotPositive(value)));
        }
        Ok(())
    }
}

/// Computes l2 + i h2 (Romero, equations 16 and 17): the coupler of a four-bar is such a triangle.
fn offset_from_distances(
    site: &Site<'_>,
    [first, second]: &[String; 2],
    base: f64,
    [d, e]: [f64; 2],
    side: CouplerSide,
) -> Assembled<Complex> {
    let key = site.key("distances");
    if !is_usable(base) {
        return Err(key.error(ChainFault::NotFinite(base)));
    }
    coupler_ratio(base, [d, e], side).map(|z| z * base).map_err(|error| match error {
        LinkageError::DistanceNegative { key: letter, value } => {
            key.nth(usize::from(letter == "e")).error(ChainFault::DistanceNegative(value))
        }
        _ => {
            let (first, second) = (first.clone(), second.clone());
            key.error(ChainFault::NoTriangle { first, second, base, d, e })
        }
    })
}
