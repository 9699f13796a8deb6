// A photograph beneath the target: it stays in the browser. Placed by moving it, scaled by two clicks and a length.

import { setAll, shape } from "../../src/report/html/player/svg.mjs";
import { keep, kept } from "./memory";
import type { Point } from "./messages";

const KEY = "linkwright-studio-photograph";
/** The longer side of what is kept, in pixels. */
const LARGEST = 1600;
/** More than so many characters are not remembered. */
const MOST_KEPT = 2_500_000;

/** Where the photograph lies: its lower left corner, the length of one of its pixels, how much it covers. */
export interface Placed {
  x: number;
  y: number;
  scale: number;
  opacity: number;
}

interface Photograph extends Placed {
  data: string;
  width: number;
  height: number;
}

export class Underlay {
  readonly group = shape("g", { class: "underlay" });
  private image = shape("image", { preserveAspectRatio: "none" });
  private ruler = shape("path", { class: "ruler" });
  private photo: Photograph | null = null;
  private ends: Point[] = [];

  constructor(private changed: () => void) {
    this.group.append(this.image, this.ruler);
    const photo = kept<Photograph>(KEY);
    if (
      photo &&
      /^data:image\/(jpeg|png);base64,/.test(photo.data) &&
      [photo.x, photo.y, photo.scale, photo.opacity, photo.width, photo.height].every(Number.isFinite)
    )
      this.photo = photo;
  }

  get there() {
    return this.photo !== null;
  }

  get placed(): Placed | null {
    if (!this.photo) return null;
    const { x, y, scale, opacity } = this.photo;
    return { x, y, scale, opacity };
  }

  /** The two ends of the known length, as far as they are clicked. */
  get marked() {
    return this.ends;
  }

  /** Takes a picture; a large one is made smaller. It fills the box. What is no picture is refused in words. */
  async take(file: Blob, box: [number, number, number, number]): Promise<string | null> {
    let bitmap: ImageBitmap;
    try {
      bitmap = await createImageBitmap(file);
    } catch {
      return "This is no picture that the browser can show: take a JPEG, a PNG or a WebP.";
    }
    const shrink = Math.min(1, LARGEST / Math.max(bitmap.width, bitmap.height));
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [
      Math.max(1, Math.round(bitmap.width * shrink)),
      Math.max(1, Math.round(bitmap.height * shrink)),
    ];
    canvas.getContext("2d")?.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
    bitmap.close();
    const { width, height } = canvas;
    const data = canvas.toDataURL(
      file.type === "image/png" && width * height < 400_000 ? "image/png" : "image/jpeg",
      0.82,
    );
    const scale = Math.max((box[2] - box[0]) / width, (box[3] - box[1]) / height);
    this.photo = {
      data,
      width,
      height,
      scale,
      x: (box[0] + box[2] - width * scale) / 2,
      y: (box[1] + box[3] - height * scale) / 2,
      opacity: 0.6,
    };
    this.ends = [];
    this.keep();
    return null;
  }

  place(placed: Partial<Placed>, last = true) {
    if (!this.photo) return;
    this.photo = { ...this.photo, ...placed };
    if (last) this.keep();
    else this.changed();
  }

  /** Makes all lengths so many times as long. */
  lengthsTimes(by: number) {
    if (this.photo) this.place({ scale: this.photo.scale * by, x: this.photo.x * by, y: this.photo.y * by });
  }

  remove() {
    this.photo = null;
    this.ends = [];
    this.keep();
  }

  /** One of the two ends of a known length. */
  mark(at: Point) {
    this.ends = this.ends.length >= 2 ? [at] : [...this.ends, at];
    this.changed();
  }

  /** The distance between the two ends as it is now. */
  get between(): number | null {
    if (this.ends.length < 2) return null;
    const [[x0, y0], [x1, y1]] = this.ends;
    return Math.hypot(x1 - x0, y1 - y0);
  }

  get width(): number {
    return this.photo ? this.photo.width * this.photo.scale : 0;
  }

  /** Makes it so wide: its lower left corner stays. */
  setWidth(width: number) {
    if (this.photo && width > 0) this.place({ scale: width / this.photo.width });
  }

  /** Whether the marked distance can be so long. */
  canBe(length: number): boolean {
    return (this.between ?? 0) > 0 && length > 0 && Number.isFinite(length);
  }

  /** Makes the marked distance so long: the first end stays where it is. */
  setLength(length: number) {
    const now = this.between;
    if (!this.photo || !now || !this.canBe(length)) return;
    const by = length / now;
    const [[x0, y0]] = this.ends;
    this.ends = [];
    this.place({ scale: this.photo.scale * by, x: x0 + (this.photo.x - x0) * by, y: y0 + (this.photo.y - y0) * by });
  }

  draw(toPixel: (p: Point) => Point) {
    const { photo } = this;
    this.group.classList.toggle("absent", !photo);
    if (!photo) return;
    const [left, top] = toPixel([photo.x, photo.y + photo.height * photo.scale]);
    const [right, bottom] = toPixel([photo.x + photo.width * photo.scale, photo.y]);
    if (this.image.getAttribute("href") !== photo.data) setAll(this.image, { href: photo.data });
    setAll(this.image, { x: left, y: top, width: right - left, height: bottom - top, opacity: photo.opacity });
    const ends = this.ends.map(toPixel);
    const cross = ends.map(([x, y]) => `M${x - 7} ${y}h14M${x} ${y - 7}v14`).join("");
    setAll(this.ruler, { d: cross + (ends.length === 2 ? `M${ends[0].join(" ")}L${ends[1].join(" ")}` : "") });
  }

  private keep() {
    keep(KEY, this.photo && this.photo.data.length <= MOST_KEPT ? this.photo : null);
    this.changed();
  }
}
