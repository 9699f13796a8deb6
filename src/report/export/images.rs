//! Pictures of the linkage with its coupler curve and target: still as PNG, animated as GIF.

use super::model::Model;
use super::settings::Refusal;
use super::skeleton::Skeleton;
use crate::files::generator;
use crate::mechanism::{Complex, LoopJoints};
use crate::report::scene::{Bounds, positions_through};
use std::collections::BTreeMap;
use std::fmt::Display;
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

type Rgb = [u8; 3];
const PAPER: Rgb = [0xff, 0xff, 0xff];
const LINKS: Rgb = [0x34, 0x49, 0x5e];
const COUPLER: Rgb = [0xd6, 0xdf, 0xe8];
const CURVE: Rgb = [0xc0, 0x39, 0x2b];
const TARGET: Rgb = [0x24, 0x71, 0xa3];

/// The longer side of a still picture and of an animation, in pixels.
const STILL_PX: usize = 1000;
const MOVING_PX: usize = 480;
/// The number of frames of a turn, and the time of each in hundredths of a second.
const FRAMES: usize = 90;
const DELAY: u16 = 4;
/// The margin around the drawing, as a fraction of its longer side.
const ROOM: f64 = 0.06;

fn failed(why: impl Display) -> Refusal {
    Refusal::new(format!("the picture cannot be written: {why}"), "choose another size_px")
}

/// Draws a still picture as PNG.
pub(super) fn png(model: &Model<'_>) -> Result<Vec<u8>, Refusal> {
    let at = model.pose()?;
    let sheet = Sheet::around(model, &[at], model.settings.size_px.unwrap_or(STILL_PX));
    let mut picture = sheet.background(model)?;
    sheet.linkage(&mut picture, model, &at);
    let bytes = picture.encode_png().map_err(failed)?;
    Ok(with_software(bytes))
}

/// Returns a PNG with the name of its generator in a chunk `tEXt`, "Software" (PNG 1.2, 4.2.3), after the header
/// `IHDR`.
fn with_software(mut png: Vec<u8>) -> Vec<u8> {
    /// The length of the signature (8 bytes) and the header: length, type, 13 bytes, check sum.
    const HEADER: usize = 8 + 4 + 4 + 13 + 4;
    let text = format!("Software\0{} {}", generator::NAME, env!("CARGO_PKG_VERSION"));
    let typed = [b"tEXt", text.as_bytes()].concat();
    // A version is a few bytes long.
    let length = text.len() as u32;
    let chunk = [&length.to_be_bytes(), typed.as_slice(), &crc32(&typed).to_be_bytes()].concat();
    if png.len() >= HEADER {
        png.splice(HEADER..HEADER, chunk);
    }
    png
}

/// Returns the check sum of ISO 3309, as PNG uses it (annex D of its specification).
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(
            crc ^ u32::from(*byte),
            |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 },
        )
    })
}

/// Draws a turn of the motion as GIF, repeated endlessly.
pub(super) fn gif(model: &Model<'_>) -> Result<Vec<u8>, Refusal> {
    let (position, start) = model.start()?;
    let n = model.settings.frames.unwrap_or(FRAMES);
    let poses = positions_through(model.linkage, [position], n).pop().unwrap_or(vec![start]);
    let sheet = Sheet::around(model, &poses, model.settings.size_px.unwrap_or(MOVING_PX));
    let background = sheet.background(model)?;
    let palette = palette();
    let flat: Vec<u8> = palette.iter().flatten().copied().collect();
    let (width, height) = (sheet.width as u16, sheet.height as u16);
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &flat).map_err(failed)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
    let comment: gif::AnyExtension = gif::Extension::Comment.into();
    encoder.write_raw_extension(comment, &[generator::mark().as_bytes()]).map_err(failed)?;
    let mut known = BTreeMap::new();
    let mut index = |colour: Rgb| match colour {
        PAPER => 0,
        _ => *known.entry(colour).or_insert_with(|| nearest(&palette, colour)),
    };
    for at in &poses {
        let mut picture = background.clone();
        sheet.linkage(&mut picture, model, at);
        let pixels: Vec<u8> = picture.data().chunks_exact(4).map(|p| index([p[0], p[1], p[2]])).collect();
        let mut frame = gif::Frame::from_indexed_pixels(width, height, pixels, None);
        frame.delay = DELAY;
        encoder.write_frame(&frame).map_err(failed)?;
    }
    drop(encoder);
    Ok(bytes)
}

/// The map from the plane to the picture.
struct Sheet {
    low: Complex,
    high: Complex,
    /// The scale, in pixels per millimetre.
    scale: f64,
    width: u32,
    height: u32,
    /// The longer side, in pixels: line widths are fractions of it.
    side: f32,
}

impl Sheet {
    fn around(model: &Model<'_>, poses: &[LoopJoints], side: usize) -> Self {
        let joints = poses.iter().flat_map(|at| Skeleton::of(model, at).points().collect::<Vec<_>>());
        let all = joints.chain(model.target.iter().copied()).chain(model.curves.iter().flatten().copied());
        let [low, high] = Bounds::of(all).corners();
        let extent = (high - low).re.max((high - low).im);
        let room = Complex::new(ROOM * extent, ROOM * extent);
        let (low, high) = (low - room, high + room);
        let size = high - low;
        let scale = side as f64 / size.re.max(size.im);
        let pixels = |x: f64| (x * scale).ceil().clamp(1.0, side as f64) as u32;
        Sheet { low, high, scale, width: pixels(size.re), height: pixels(size.im), side: side as f32 }
    }

    fn at(&self, p: Complex) -> (f32, f32) {
        (((p.re - self.low.re) * self.scale) as f32, ((self.high.im - p.im) * self.scale) as f32)
    }

    fn path(&self, points: &[Complex], closed: bool) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for (i, p) in points.iter().enumerate() {
            let (x, y) = self.at(*p);
            if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
        }
        if closed {
            builder.close();
        }
        builder.finish()
    }

    fn line(&self, picture: &mut Pixmap, points: &[Complex], closed: bool, colour: Rgb, width: f32) {
        let stroke = Stroke {
            width: width * self.side,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        if let Some(path) = self.path(points, closed) {
            picture.stroke_path(&path, &paint(colour, 255), &stroke, Transform::identity(), None);
        }
    }

    fn disc(&self, picture: &mut Pixmap, centre: Complex, colour: Rgb, radius: f32) {
        let (x, y) = self.at(centre);
        if let Some(path) = PathBuilder::from_circle(x, y, radius * self.side) {
            picture.fill_path(&path, &paint(colour, 255), FillRule::Winding, Transform::identity(), None);
        }
    }

    /// Draws the parts that do not move: coupler curve and target.
    fn background(&self, model: &Model<'_>) -> Result<Pixmap, Refusal> {
        let mut picture = Pixmap::new(self.width, self.height).ok_or_else(|| failed("it is too large"))?;
        picture.fill(Color::from_rgba8(PAPER[0], PAPER[1], PAPER[2], 255));
        for curve in &model.curves {
            self.line(&mut picture, curve, true, CURVE, 0.004);
        }
        for at in &model.target {
            self.disc(&mut picture, *at, TARGET, 0.007);
            self.disc(&mut picture, *at, PAPER, 0.004);
        }
        for frame in &model.wanted {
            self.line(&mut picture, frame, false, TARGET, 0.003);
        }
        Ok(picture)
    }

    /// Draws the links and joints of a position.
    fn linkage(&self, picture: &mut Pixmap, model: &Model<'_>, at: &LoopJoints) {
        let skeleton = Skeleton::of(model, at);
        if let Some(line) = skeleton.line {
            self.line(picture, &line, false, LINKS, if skeleton.ground.is_empty() { 0.004 } else { 0.012 });
        }
        if let Some(path) = self.path(&skeleton.coupler, true).filter(|_| skeleton.coupler.len() > 2) {
            picture.fill_path(&path, &paint(COUPLER, 170), FillRule::Winding, Transform::identity(), None);
        }
        self.line(picture, &skeleton.coupler, true, LINKS, 0.006);
        for (_, corners) in &skeleton.links {
            if let Some(path) = self.path(corners, true).filter(|_| corners.len() > 2) {
                picture.fill_path(
                    &path,
                    &paint(COUPLER, 170),
                    FillRule::Winding,
                    Transform::identity(),
                    None,
                );
            }
            self.line(picture, corners, true, LINKS, if corners.len() > 2 { 0.006 } else { 0.012 });
        }
        self.line(picture, &skeleton.crank, false, LINKS, 0.012);
        if let Some(follower) = skeleton.follower {
            self.line(picture, &follower, false, LINKS, 0.012);
        }
        if let Some(path) = self.path(&skeleton.block, true) {
            picture.fill_path(&path, &paint(PAPER, 255), FillRule::Winding, Transform::identity(), None);
            self.line(picture, &skeleton.block, true, LINKS, 0.006);
        }
        for (name, joint) in &skeleton.joints {
            let is_pivot = matches!(*name, "A" | "B") || skeleton.ground.contains(joint);
            let radius = if is_pivot { 0.017 } else { 0.012 };
            if *name != "P" {
                self.disc(picture, *joint, LINKS, radius);
                self.disc(picture, *joint, PAPER, radius - 0.005);
            }
        }
        self.disc(picture, at.joints.coupler_point, CURVE, 0.012);
        if let Some(frame) = model.body(at) {
            self.line(picture, &frame, false, CURVE, 0.007);
        }
    }
}

fn paint([red, green, blue]: Rgb, alpha: u8) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, alpha);
    paint
}

/// Returns the colours of an animation: the drawing's colours and their mixtures with the paper's, for smoothed edges.
fn palette() -> Vec<Rgb> {
    const STEPS: i32 = 24;
    let mut colours = vec![PAPER];
    for colour in [LINKS, CURVE, TARGET, COUPLER] {
        for step in 1..=STEPS {
            let mixed = |i: usize| {
                let (from, to) = (i32::from(PAPER[i]), i32::from(colour[i]));
                // A value between two bytes fits into a byte.
                (from + (to - from) * step / STEPS) as u8
            };
            colours.push([0, 1, 2].map(mixed));
        }
    }
    colours
}

/// Returns the place of the nearest colour in a palette.
fn nearest(palette: &[Rgb], colour: Rgb) -> u8 {
    let distance = |other: &Rgb| -> i32 {
        other.iter().zip(colour).map(|(x, y)| (i32::from(*x) - i32::from(y)).pow(2)).sum()
    };
    let best = palette.iter().enumerate().min_by_key(|(_, other)| distance(other));
    best.map_or(0, |(i, _)| i as u8)
}

#[cfg(test)]
mod tests {
    use super::crc32;

    #[test]
    fn the_check_sum_is_that_of_the_standard() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        // The last chunk of every PNG.
        assert_eq!(crc32(b"IEND"), 0xae42_6082);
    }
}
