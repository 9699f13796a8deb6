// Made by studio/wire.mjs from docs/studio-messages.json and docs/studio-openapi.json: not to be changed by hand.

/**
 * The reference direction of prescribed crank angles.
 */
export type AngleOffset = "free" | "fixed" | "ground";
/**
 * The meaning of the player's one parameter q, in degrees.
 */
export type DriveKind = "turn" | "rock" | "through" | "none";
/**
 * The kinds of linkages that a crank drives.
 */
export type LinkageKind = "four-bar" | "slider-crank" | "inverted-slider-crank" | "six-bar" | "eight-bar";
/**
 * The sense in which the follower turns while the crank turns as its angles are written.
 */
export type Sense = "any" | "same" | "opposite";
/**
 * The activity of the studio for a tab.
 */
export type Doing = "following" | "searching" | "done" | "refused";
/**
 * A value of a problem file's key. It is displayed as it is typed in `--set KEY=VALUE`.
 */
export type TypedValue = number | number[] | [number, number][] | string | string[];
/**
 * How sure it is that a search has missed nothing better.
 */
export type Sure = "sure" | "fairly" | "not";
/**
 * The rule for the circuits or the branches of a motion.
 */
export type OnePolicy = "one" | "any";
/**
 * The ways in which the motion may come back to the first point of a target that ends where it begins.
 */
export type ClosingPolicy = "one-way" | "any";
/**
 * The direction in which the crank turns along the points.
 */
export type DirectionPolicy = "any" | "ccw" | "cw";
/**
 * The rule for the range of the input.
 */
export type InputPolicy = "any" | "full-turn";
/**
 * The method of the search.
 */
export type Method = "auto" | "genetic" | "differential-evolution" | "least-squares" | "continuation";
/**
 * The quantity that is minimised.
 */
export type Objective = "sum-of-squares" | "max-deviation";
/**
 * The rule for the order of the points.
 */
export type OrderPolicy = "required" | "any";
/**
 * An interval [low, high]; a fixed value has low = high.
 *
 * @minItems 2
 * @maxItems 2
 */
export type Limits = [unknown, unknown];
/**
 * The motion over which the transmission angle is judged.
 */
export type TransmissionOver = "cycle" | "used";
/**
 * The types of four-bars, told by which link is the shortest where the Grashof margin is positive.
 */
export type LinkageType =
  "crank-rocker" | "rocker-crank" | "double-crank" | "double-rocker" | "triple-rocker" | "change-point";
/**
 * The unit that labels lengths.
 */
export type Unit = "mm" | "cm" | "m" | "in";
/**
 * The form of a comparison.
 */
export type Form = "json" | "html" | "csv" | "svg";
/**
 * The source of a linkage.
 */
export type Source =
  | {
      job: OfJob;
    }
  | {
      drawn: Drawn;
    };
/**
 * A defect of a motion through the points, with the points at which it occurs (counted from 0).
 */
export type Defect =
  | {
      /**
       * The points at which the motion would have to jump back; `[0]` where it returns to its first point only
       * through all others in reverse.
       */
      at: number[];
      kind: "order";
    }
  | {
      /**
       * The points on another branch than point 0, or reached only by way of one.
       */
      at: number[];
      kind: "branch";
    }
  | {
      /**
       * The points that cannot be reached from point 0.
       */
      at: number[];
      kind: "circuit";
    };
/**
 * An end of a spring.
 */
export type End =
  | {
      joint: string;
    }
  | {
      /**
       * @minItems 2
       * @maxItems 2
       */
      point: [number, number];
    };
/**
 * The state of a job.
 */
export type JobState = "running" | "done" | "stopped" | "broken-off" | "elsewhere" | "failed" | "unreadable";
/**
 * The kind of a text.
 */
export type Kind = "csv" | "svg" | "problem" | "report";

export interface Wire {
  AngleErrorRecord: AngleErrorRecord;
  AngleOffset: AngleOffset;
  Answer: Answer;
  Ask: Ask;
  Best: Best;
  BodyAsk: BodyAsk;
  ChainKeys: ChainKeys;
  Change: Change;
  ClosingPolicy: ClosingPolicy;
  CompareAsk: CompareAsk;
  Compared: Compared;
  ComparedRow: ComparedRow;
  Counted: Counted;
  CrankKeys: CrankKeys;
  CrankLinkage: CrankLinkage;
  CrankLinkage2: CrankLinkage2;
  CurvePlace: CurvePlace;
  Defect: Defect;
  Details: Details;
  DetailsAsk: DetailsAsk;
  DirectionPolicy: DirectionPolicy;
  Doing: Doing;
  Drawn: Drawn;
  Drive: Drive;
  DriveKind: DriveKind;
  DyadKeys: DyadKeys;
  End: End;
  Expect: Expect;
  ExpectedCensus: ExpectedCensus;
  ExportAsk: ExportAsk;
  Form: Form;
  FormulaSpec: FormulaSpec;
  FunctionAsk: FunctionAsk;
  InputPolicy: InputPolicy;
  JobAsk: JobAsk;
  JobList: JobList;
  JobProgress: JobProgress;
  JobResult: JobResult;
  JobShown: JobShown;
  JobState: JobState;
  JudgeAsk: JudgeAsk;
  Kind: Kind;
  Known: Known;
  LeftOut: LeftOut;
  Limits: Limits;
  LinkageAsk: LinkageAsk;
  LinkageKind: LinkageKind;
  LinkageType: LinkageType;
  Loaded: Loaded;
  LoadsAsk: LoadsAsk;
  Method: Method;
  Objective: Objective;
  OfJob: OfJob;
  OnePolicy: OnePolicy;
  Opened: Opened;
  OrderPolicy: OrderPolicy;
  PinMap: PinMap;
  PointKeys: PointKeys;
  Published: Published;
  RawPoints: RawPoints;
  Reading: Reading;
  Relaxation: Relaxation;
  Sense: Sense;
  Shown: Shown;
  Source: Source;
  SpringAsk: SpringAsk;
  Sure: Sure;
  Text: Text;
  TimingSpec: TimingSpec;
  Tool: Tool;
  Track: Track;
  TransmissionOver: TransmissionOver;
  TypedValue: TypedValue;
  Unit: Unit;
}
/**
 * The errors of a body's angle over the poses that give one, or of the follower's over the pairs of a function.
 */
export interface AngleErrorRecord {
  /**
   * The number of the point at which it is, from 0.
   */
  max_at: number;
  /**
   * The largest, degrees.
   */
  max_deg: number;
  /**
   * The root of the mean square, degrees.
   */
  rms_deg: number;
}
/**
 * The answer to an edit. Later answers to the same edit replace earlier ones; answers that were not sent before the
 * next came are dropped.
 */
export interface Answer {
  /**
   * The linkages, better first; in exact mode all real ones through the nine points.
   */
  candidates: Shown[];
  doing: Doing;
  map?: PinMap;
  nine?: Counted;
  /**
   * The part of the search's budget that is used, 0 to 1; most searches end before it is used up.
   */
  progress?: number;
  /**
   * If nothing is acceptable: the changes that help, nearest first.
   */
  relaxations: Relaxation[];
  /**
   * The same in words: what is done, how sure it is, and what prevents better answers.
   */
  said: string;
  sure?: Sure;
  /**
   * The edit's version.
   */
  version: number;
}
/**
 * A linkage with its figures, ready to be played.
 */
export interface Shown {
  /**
   * Through nine points: the abilities of the best of the curve's six mechanisms.
   */
  ability?: string;
  /**
   * Whether every requirement is met and no defect is there that is not allowed.
   */
  accepted: boolean;
  angle?: AngleErrorRecord;
  /**
   * Through nine points: the proved distance within which there is one exact linkage.
   */
  certified_within?: number;
  /**
   * The crank angle at each target point, degrees.
   */
  crank_deg: number[];
  drive: Drive;
  /**
   * In a motion: the angle from the direction C -> D to the body's x axis, degrees.
   */
  frame_deg?: number;
  /**
   * Longest over shortest link.
   */
  link_ratio: number;
  linkage: CrankLinkage2;
  /**
   * The largest error.
   */
  max: number;
  /**
   * Its number: it keeps it while it follows the hand.
   */
  number?: number;
  /**
   * In a function: the follower's angle from the line A -> B at an output of 0, degrees.
   */
  output_offset_deg?: number;
  /**
   * Its rank, from 1.
   */
  rank: number;
  /**
   * The root of the mean squared error.
   */
  rms: number;
  sense?: Sense;
  /**
   * The assembly (1 or -1) at each point.
   */
  t1_at: number[];
  track?: Track;
  /**
   * The worst transmission angle, degrees from 0 to 90.
   */
  transmission_deg: number;
  /**
   * Its type; of a linkage with a slider its kind.
   */
  type: string;
  /**
   * The requirements that are not met, by their keys, and the defects.
   */
  unmet: string[];
  /**
   * The number of the worst point, from 0.
   */
  worst: number;
}
/**
 * The motion that a page plays: the circuit of the first point, and of it the branch used or all of it.
 */
export interface Drive {
  /**
   * Half of the crank's range; 180 where it turns fully.
   */
  half_width_deg: number;
  kind: DriveKind;
  /**
   * The middle of the crank's range, degrees in (-180, 180].
   */
  middle_deg: number;
  /**
   * The assembly; where toggles are passed, that of the first point.
   */
  t1: number;
}
/**
 * A linkage by its keys, which may be no linkage: every key of every kind.
 */
export interface CrankLinkage2 {
  /**
   * The fixed pivot of the crank, of every kind but those of several loops.
   *
   * @minItems 2
   * @maxItems 2
   */
  A?: [number, number];
  /**
   * The fixed pivot of a four-bar's follower, or of the block of an inverted slider-crank.
   *
   * @minItems 2
   * @maxItems 2
   */
  B?: [number, number];
  /**
   * |AC|, of every kind but those of several loops.
   */
  a?: number;
  /**
   * |CD| of a four-bar and of a slider-crank.
   */
  b?: number;
  /**
   * |BD| of a four-bar.
   */
  c?: number;
  chain?: ChainKeys;
  /**
   * P along the coupler from C, of kinds with a slider.
   */
  coupler_x?: number;
  /**
   * P to the left of the coupler, of kinds with a slider.
   */
  coupler_y?: number;
  /**
   * |CP| of a four-bar.
   */
  d?: number;
  /**
   * |DP| of a four-bar.
   */
  e?: number;
  kind?: LinkageKind;
  /**
   * The direction of a slider-crank's line from the x axis, degrees.
   */
  line_deg?: number;
  /**
   * Q, a point of a slider-crank's line, from which the slider's place counts.
   *
   * @minItems 2
   * @maxItems 2
   */
  line_point?: [number, number];
  /**
   * The distance of B to the left of the rod's line through C, of an inverted slider-crank.
   */
  offset?: number;
  /**
   * The assembly: of a four-bar 1 where D lies left of the line from C to B; of a slider-crank where D is the one of two
   * places that lies further along the line; of an inverted one where the block is ahead of C along the rod.
   */
  t1?: number;
  /**
   * The side of a four-bar's coupler point: 1 where P lies left of the line from C to D.
   */
  t2?: number;
}
/**
 * The keys of `[chain]`: fixed pivots, a driven crank, dyads and points.
 */
export interface ChainKeys {
  crank: CrankKeys;
  /**
   * Two links that meet in a new joint, each.
   */
  dyad: DyadKeys[];
  /**
   * Fixed pivots: a name and a point each.
   */
  pivots: {
    /**
     * @minItems 2
     * @maxItems 2
     */
    [k: string]: [number, number];
  };
  /**
   * Points on links.
   */
  point?: PointKeys[];
  /**
   * The name of the point whose path is drawn.
   */
  trace: string;
}
/**
 * The driven crank.
 */
export interface CrankKeys {
  /**
   * The name of the joint that it carries.
   */
  joint: string;
  /**
   * From pivot to joint.
   */
  length: number;
  /**
   * The name of its fixed pivot.
   */
  pivot: string;
}
/**
 * Two links from two points to a new joint.
 */
export interface DyadKeys {
  /**
   * The two points that it hangs on.
   *
   * @minItems 2
   * @maxItems 2
   */
  from: [string, string];
  /**
   * The name of the new joint.
   */
  joint: string;
  /**
   * The two links.
   *
   * @minItems 2
   * @maxItems 2
   */
  lengths: [number, number];
  /**
   * 1: the joint lies left of the line from the first point to the second; -1: right.
   */
  side: number;
}
/**
 * A point on a link.
 */
export interface PointKeys {
  /**
   * Along the line from the first point to the second, and to its left, from the first point.
   *
   * @minItems 2
   * @maxItems 2
   */
  at: [number, number];
  /**
   * The name of the new point.
   */
  name: string;
  /**
   * Two points of the link.
   *
   * @minItems 2
   * @maxItems 2
   */
  on: [string, string];
}
/**
 * The motion of a linkage of several loops.
 */
export interface Track {
  /**
   * The dyad of each link, counted from 1; 0 of the crank.
   */
  dyads: number[];
  /**
   * The joints of each moving link, as indices of their names.
   */
  links: number[][];
  /**
   * The names of the joints, the fixed pivots first, P the last.
   */
  names: string[];
  /**
   * The fixed pivots.
   */
  pivots: [number, number][];
  /**
   * Evenly over a turn from a crank angle of 0: x and y of each moving joint, the transmission angle of each dyad
   * (radians), velocity and acceleration of P at a crank of one radian a second.
   */
  rows: number[][];
}
/**
 * How nearly the points of a body move on circles while it takes its poses. A fixed pivot is the centre of the circle.
 */
export interface PinMap {
  /**
   * The places of least error, the best first: the pin in the body's frame and the fixed pivot of its circle.
   */
  best: [[number, number], [number, number]][];
  /**
   * Of four poses the circle-point and centre-point curves, in stretches without a gap.
   */
  curves?: CurvePlace[][];
  /**
   * Places a side of the square.
   */
  grid: number;
  /**
   * Half the side, a length: the square lies about the body's origin, along its axes.
   */
  half: number;
  /**
   * One letter a place, row by row from the least y, each from the least x: `#` where the rms distance from the best
   * circle is a thousandth of the poses' size or less, the next 56 letters of ASCII (to `[`) for errors up to a third
   * of the size, evenly in their logarithms.
   */
  levels: string;
}
/**
 * A place of the circle-point and centre-point curves of four poses.
 */
export interface CurvePlace {
  /**
   * The worst transmission angle between the poses, in degrees, of the best linkage without defects that has its pin here;
   * absent if there is none.
   */
  deg?: number;
  /**
   * The circle point: the pin in the body's frame.
   *
   * @minItems 2
   * @maxItems 2
   */
  pin: [number, number];
  /**
   * The centre point: its fixed pivot.
   *
   * @minItems 2
   * @maxItems 2
   */
  pivot: [number, number];
}
/**
 * The linkages through nine points, counted.
 */
export interface Counted {
  /**
   * Solutions up to cognates, complex ones included.
   */
  classes: number;
  /**
   * Of these, on one branch.
   */
  free_of_defects: number;
  /**
   * Of these, in order.
   */
  in_order: number;
  /**
   * Of these, those that pass all points on one circuit.
   */
  one_circuit: number;
  /**
   * Those that are linkages.
   */
  real: number;
  /**
   * The same and more in words.
   */
  said: string[];
}
/**
 * A change of the problem after which something acceptable is found.
 */
export interface Relaxation {
  /**
   * Its rms error.
   */
  rms: number;
  /**
   * The keys to set.
   */
  set: Change[];
  /**
   * The best sum of squares then.
   */
  sum_sq: number;
}
/**
 * A key of the problem file with another value.
 */
export interface Change {
  from: TypedValue;
  /**
   * The key, as in `--set KEY=VALUE`.
   */
  key: string;
  to: TypedValue;
}
/**
 * An edit: a target and the requirements of its linkage, as a tab has them. All lengths are in `unit`.
 */
export interface Ask {
  body?: BodyAsk;
  branch?: OnePolicy;
  circuit?: OnePolicy;
  /**
   * Whether the target is a closed curve.
   */
  closed?: boolean;
  closing?: ClosingPolicy;
  direction?: DirectionPolicy;
  expect?: Known;
  /**
   * The box that must hold every joint and the coupler point over the motion used.
   *
   * @minItems 4
   * @maxItems 4
   */
  footprint_in?: [number, number, number, number];
  /**
   * The target has nothing to do with the one before: nothing is to follow it.
   */
  fresh?: boolean;
  from?: CrankLinkage;
  function?: FunctionAsk;
  /**
   * The number of a linkage that stays among the answers while it can follow the hand.
   */
  held?: number;
  input?: InputPolicy;
  /**
   * Other keys of the problem file under `design`, `require` and `solve`, each with its value as it is typed there.
   */
  kept?: {
    [k: string]: string;
  };
  /**
   * Longest over shortest link at most.
   */
  link_ratio_max?: number;
  /**
   * In a motion: the answers are to hold the map of the places of a pin.
   */
  map?: boolean;
  /**
   * The kinds of linkages that are searched for; empty: four-bars.
   */
  mechanism?: LinkageKind[];
  method?: Method;
  /**
   * The hand is still moving: the search waits until it rests.
   */
  moving?: boolean;
  /**
   * The problem's name, as in problem files.
   */
  name?: string;
  objective?: Objective;
  order?: OrderPolicy;
  /**
   * The box that must hold both fixed pivots: xmin, ymin, xmax, ymax.
   *
   * @minItems 4
   * @maxItems 4
   */
  pivots_in?: [number, number, number, number];
  /**
   * The target points in their order: 3 to 1000; in a motion the places of the body's origin, in a function the pairs
   * [input, output] in degrees: 2 to 1000.
   */
  points: [number, number][];
  raw?: RawPoints;
  /**
   * The seed of every draw.
   */
  seed?: number;
  /**
   * The source of the problem, in words.
   */
  source?: string;
  stroke?: Limits;
  time_ratio?: Limits;
  timing?: TimingSpec;
  /**
   * The largest error accepted at any point.
   */
  tolerance?: number;
  /**
   * The largest error accepted at each point, in place of `tolerance`.
   */
  tolerances?: number[];
  /**
   * The least transmission angle, degrees.
   */
  transmission_deg_min?: number;
  transmission_over?: TransmissionOver;
  /**
   * The types allowed of four-bars; empty: any.
   */
  types?: LinkageType[];
  unit?: Unit;
  /**
   * Counts the tab's edits; the answer names the edit that it answers.
   */
  version?: number;
  /**
   * One positive weight a point.
   */
  weights?: number[];
}
/**
 * The body of a motion. Angles in degrees from the x axis, counter-clockwise positive.
 */
export interface BodyAsk {
  /**
   * The angle of the body at each point; null where only the place counts.
   */
  angle_deg: number[];
  /**
   * A length: an angle error of one radian counts like an error of the place of this length; absent: the size of the
   * points.
   */
  angle_weight?: number;
  /**
   * The outline of the body in its own frame: lines that are drawn with it, not read.
   */
  outline?: [number, number][][];
  /**
   * The largest error of the angle accepted at any point.
   */
  tolerance_deg?: number;
  /**
   * The largest error of the angle accepted at each point, in place of `tolerance_deg`.
   */
  tolerances_deg?: number[];
}
/**
 * The known answer of a problem, as under `[expect]` in its file.
 */
export interface Known {
  answer: Expect;
  /**
   * A hash of the problem that it belongs to: of its target, bounds, requirements and objective.
   */
  of: string;
}
/**
 * The known facts about a problem's answer.
 */
export interface Expect {
  /**
   * The least sum of squared errors that is known.
   */
  best_known_sum_sq?: number;
  exact?: ExpectedCensus;
  /**
   * The sum that a run has to reach to count as a hit; where silent, best_known_sum_sq.
   */
  goal_sum_sq?: number;
  /**
   * The largest error of the body's angle in that answer, degrees.
   */
  max_deg?: number;
  /**
   * The least objective that is known of a motion: squared errors of the places plus angle_weight^2 times squared errors
   * of the angles in radians.
   */
  objective?: number;
  /**
   * Answers that were published.
   */
  published?: Published[];
  /**
   * The rms error of the body's angle in that answer, degrees.
   */
  rms_deg?: number;
}
/**
 * The number of linkages through nine points, up to cognates, through poses and points, or through eight points of a linkage with a
 * slider.
 */
export interface ExpectedCensus {
  /**
   * Isolated solutions, real and complex.
   */
  classes?: number;
  /**
   * Of these, on one branch.
   */
  free_of_defects?: number;
  /**
   * Of these, in the order of the points.
   */
  in_order?: number;
  /**
   * Of these, on one circuit.
   */
  one_circuit?: number;
  /**
   * Real linkages.
   */
  real?: number;
}
/**
 * An answer that was published.
 */
export interface Published {
  /**
   * The crank angles that were published, degrees from the ground line.
   */
  crank_deg?: number[];
  /**
   * A remark.
   */
  note?: string;
  /**
   * The error that was printed.
   */
  printed_sum_sq?: number;
  /**
   * The error that the vector has when this project evaluates it.
   */
  recomputed_sum_sq?: number;
  /**
   * Author and year.
   */
  source: string;
  /**
   * The side on which it closes: 1: D lies left of the line from C to B; -1: right.
   */
  t1?: number;
  /**
   * r1 ground, r2 crank, r3 coupler, r4 follower, rcx, rcy, x0, y0, theta0 (radians).
   */
  vector?: number[];
}
/**
 * A linkage by its keys, which may be no linkage: every key of every kind.
 */
export interface CrankLinkage {
  /**
   * The fixed pivot of the crank, of every kind but those of several loops.
   *
   * @minItems 2
   * @maxItems 2
   */
  A?: [number, number];
  /**
   * The fixed pivot of a four-bar's follower, or of the block of an inverted slider-crank.
   *
   * @minItems 2
   * @maxItems 2
   */
  B?: [number, number];
  /**
   * |AC|, of every kind but those of several loops.
   */
  a?: number;
  /**
   * |CD| of a four-bar and of a slider-crank.
   */
  b?: number;
  /**
   * |BD| of a four-bar.
   */
  c?: number;
  chain?: ChainKeys;
  /**
   * P along the coupler from C, of kinds with a slider.
   */
  coupler_x?: number;
  /**
   * P to the left of the coupler, of kinds with a slider.
   */
  coupler_y?: number;
  /**
   * |CP| of a four-bar.
   */
  d?: number;
  /**
   * |DP| of a four-bar.
   */
  e?: number;
  kind?: LinkageKind;
  /**
   * The direction of a slider-crank's line from the x axis, degrees.
   */
  line_deg?: number;
  /**
   * Q, a point of a slider-crank's line, from which the slider's place counts.
   *
   * @minItems 2
   * @maxItems 2
   */
  line_point?: [number, number];
  /**
   * The distance of B to the left of the rod's line through C, of an inverted slider-crank.
   */
  offset?: number;
  /**
   * The assembly: of a four-bar 1 where D lies left of the line from C to B; of a slider-crank where D is the one of two
   * places that lies further along the line; of an inverted one where the block is ahead of C along the rod.
   */
  t1?: number;
  /**
   * The side of a four-bar's coupler point: 1 where P lies left of the line from C to D.
   */
  t2?: number;
}
/**
 * The angles of a function.
 */
export interface FunctionAsk {
  input_offset?: AngleOffset;
  of?: FormulaSpec;
  output_offset?: AngleOffset;
  sense?: Sense;
  /**
   * The largest error of the output accepted at any pair, degrees.
   */
  tolerance_deg?: number;
  /**
   * The largest error of the output accepted at each pair, degrees, in place of `tolerance_deg`.
   */
  tolerances_deg?: number[];
}
/**
 * A formula y = f(x) whose values are the outputs.
 */
export interface FormulaSpec {
  /**
   * The formula in x.
   */
  formula: string;
  /**
   * The first and the last x.
   *
   * @minItems 2
   * @maxItems 2
   */
  over: [number, number];
}
/**
 * Points as they were digitised, with the smoothing and resampling that made the target's points of them.
 */
export interface RawPoints {
  /**
   * As they were given.
   */
  points: [number, number][];
  /**
   * The number of points taken evenly along the path.
   */
  samples?: number;
  /**
   * The standard deviation of the smoothing, a length along the path.
   */
  smooth?: number;
}
/**
 * Prescribed crank angles.
 */
export interface TimingSpec {
  /**
   * One a target, degrees, counter-clockwise positive.
   */
  crank_deg: number[];
  /**
   * The targets whose crank angle is free after all, counted from 0, in their order: what `crank_deg` says of them lies
   * between their neighbours and is a guess.
   */
  free?: number[];
  offset: AngleOffset;
}
/**
 * The figures of a result's best candidate.
 */
export interface Best {
  /**
   * Whether every requirement is met.
   */
  accepted: boolean;
  /**
   * The largest error.
   */
  max: number;
  /**
   * The root of the mean squared error.
   */
  rms: number;
  /**
   * The worst transmission angle, degrees from 0 to 90.
   */
  transmission_deg: number;
  /**
   * Its type.
   */
  type: string;
}
/**
 * Linkages that are to be compared.
 */
export interface CompareAsk {
  form?: Form;
  /**
   * The linkages: 1 to 20.
   */
  of: Source[];
  /**
   * The figures that they are ranked by, as `linkwright compare --sort` takes them; empty: the sum of squared errors.
   */
  sort?: string[];
}
/**
 * A candidate of a saved result.
 */
export interface OfJob {
  /**
   * The result.
   */
  name: string;
  /**
   * The candidate's rank, from 1.
   */
  rank: number;
}
/**
 * A linkage under the hand: the parts of an answer's `Shown` that determine it.
 */
export interface Drawn {
  ask: Ask;
  /**
   * The crank angle at each target point, degrees.
   */
  crank_deg: number[];
  linkage: CrankLinkage;
  /**
   * The assembly (1 or -1) at each point.
   */
  t1_at: number[];
}
/**
 * Linkages side by side.
 */
export interface Compared {
  /**
   * The version of the format.
   */
  format: number;
  /**
   * The figures that the front is of.
   *
   * @minItems 3
   * @maxItems 3
   */
  front_of: [string, string, string];
  /**
   * Results that could not be compared.
   */
  left_out: LeftOut[];
  /**
   * Remarks in words.
   */
  notes: string[];
  /**
   * The label of the one that the others are compared with.
   */
  reference?: string;
  /**
   * The linkages, better first.
   */
  rows: ComparedRow[];
  /**
   * Whether all were found for one target.
   */
  same_target: boolean;
  /**
   * Whether the lengths of all are in one unit.
   */
  same_unit: boolean;
  /**
   * The figures by which they are ranked, in order.
   */
  sort: string[];
  tool: Tool;
  /**
   * The unit of all lengths; null where they have none in common.
   */
  unit?: string;
}
/**
 * An input without figures.
 */
export interface LeftOut {
  /**
   * The name of the input.
   */
  label: string;
  /**
   * The reason why it has no figures.
   */
  why: string;
}
/**
 * A linkage among others.
 */
export interface ComparedRow {
  /**
   * Whether it meets everything that was asked of it.
   */
  accepted: boolean;
  /**
   * By how much it is worse than the best, in per cent of the first figure.
   */
  behind_percent?: number;
  /**
   * The crank angle at each point, degrees.
   */
  crank_deg: number[];
  defects: Defect[];
  /**
   * Its figures by their names.
   */
  figures: {
    [k: string]: number | null;
  };
  /**
   * In a motion: the angle from the direction C -> D to the body's x axis, degrees.
   */
  frame_deg?: number;
  label: string;
  linkage: CrankLinkage2;
  /**
   * The point with the largest error.
   */
  max_at: number;
  /**
   * Whether it is a candidate of a run.
   */
  of_run: boolean;
  /**
   * Whether none of the others is better in all figures of the front.
   */
  on_front: boolean;
  /**
   * By how much each figure is above that of the reference.
   */
  percent_above_reference?: {
    [k: string]: number | null;
  };
  /**
   * Its place, from 1.
   */
  rank: number;
  /**
   * Its place by each of the figures by which they are ranked.
   */
  ranks: {
    [k: string]: number | null;
  };
  /**
   * The figures for which its record has other values.
   */
  recorded_differently: string[];
  /**
   * The name of its target.
   */
  target: string;
  /**
   * The motion over which the transmission angle is judged.
   */
  transmission_over: string;
  type: string;
  unit?: string;
  /**
   * The requirements that it does not meet.
   */
  unmet: string[];
}
/**
 * Name and version of the program.
 */
export interface Tool {
  /**
   * linkwright.
   */
  name: string;
  /**
   * The version.
   */
  version: string;
}
/**
 * The report's text on a linkage, with its figures.
 */
export interface Details {
  /**
   * The number of candidates of the result.
   */
  candidates: number;
  /**
   * Whether the target is a closed curve.
   */
  closed: boolean;
  /**
   * The problem's name.
   */
  name: string;
  /**
   * The target points.
   */
  points: [number, number][];
  shown: Shown;
  /**
   * The outcome of the search, as markup without scripts.
   */
  summary: string;
  /**
   * The tolerance at each point.
   */
  tolerance?: number[];
  /**
   * The least transmission angle that was asked for, degrees.
   */
  transmission_deg_min?: number;
  unit?: Unit;
  /**
   * Figures, mobility, warnings, requirements with what they cost, dimensions: as markup without scripts.
   */
  words: string;
}
/**
 * A linkage whose details are wanted.
 */
export interface DetailsAsk {
  of: Source;
}
/**
 * A linkage that is wanted as a file.
 */
export interface ExportAsk {
  /**
   * A format of `linkwright export`, or `html` (the report), `sheet` (its drawing), `points` (CSV along the
   * points), `layers` (what `linkwright build` prints), `archive` (a zip of everything that it takes to build it).
   */
  format: string;
  /**
   * With which the names in an archive begin; absent: the problem's name.
   */
  name?: string;
  of: Source;
  /**
   * Settings, as `linkwright export --set` takes them: `{"hole_mm": "4"}`. For an archive and for layers: of all its
   * files.
   */
  set?: {
    [k: string]: string;
  };
}
/**
 * A search to begin, whose result is saved. Exactly one of `ask` and `problem` is given.
 */
export interface JobAsk {
  ask?: Ask;
  /**
   * The text of a problem file. Its points stand in it: files are not read for it.
   */
  problem?: string;
  /**
   * Replace an earlier result of that name; without it such a name is refused.
   */
  replace?: boolean;
  /**
   * Keys of `[solve]` to set, with values as `--set` takes them: `{"solve.evaluations": "1000000"}`.
   */
  set?: {
    [k: string]: string;
  };
}
/**
 * All jobs: those that run and all results of the folder, by name.
 */
export interface JobList {
  /**
   * The folder, as it was named.
   */
  folder: string;
  /**
   * The jobs.
   */
  jobs: JobShown[];
  /**
   * The number of further jobs that are not listed.
   */
  more: number;
}
/**
 * A job, or a result that was made before.
 */
export interface JobShown {
  /**
   * Its name: that of its folder.
   */
  name: string;
  progress?: JobProgress;
  result?: JobResult;
  /**
   * Whether it can go on: from its checkpoint if there is one, else from the beginning.
   */
  resumable: boolean;
  /**
   * The same in words.
   */
  said: string;
  state: JobState;
}
/**
 * The progress of a search.
 */
export interface JobProgress {
  /**
   * Whether that one is acceptable.
   */
  accepted: boolean;
  /**
   * The best rms error so far, in the problem's unit of length.
   */
  best_rms?: number;
  /**
   * The budget; most searches end before it is used up.
   */
  budget: number;
  /**
   * Seconds since it began.
   */
  elapsed_s: number;
  /**
   * Evaluations so far.
   */
  evaluations: number;
  /**
   * Seconds that are left at most.
   */
  left_s?: number;
  /**
   * The phase of the search.
   */
  phase: string;
  /**
   * Evaluations a second.
   */
  rate: number;
}
/**
 * The figures of a result's record.
 */
export interface JobResult {
  /**
   * The number of accepted candidates.
   */
  accepted: number;
  best?: Best;
  /**
   * The number of candidates.
   */
  candidates: number;
  /**
   * Evaluations of the objective.
   */
  evaluations: number;
  /**
   * The method asked for.
   */
  method: string;
  /**
   * The number of target points.
   */
  points: number;
  /**
   * Whether the same problem and seed give the same record again.
   */
  reproducible: boolean;
  /**
   * The seed of every draw.
   */
  seed: number;
  unit?: Unit;
  /**
   * The version of linkwright that wrote it.
   */
  version: string;
}
/**
 * A linkage that was changed by hand, over the target of an edit.
 */
export interface JudgeAsk {
  ask: Ask;
  linkage: CrankLinkage;
}
/**
 * A linkage to be written as a file.
 */
export interface LinkageAsk {
  linkage: CrankLinkage;
  /**
   * Its name.
   */
  name?: string;
  unit?: Unit;
}
/**
 * The loads of a linkage over the range of its crank.
 */
export interface Loaded {
  /**
   * The torque on the crank, N m, at crank angles in degrees: [angle, torque] along each stretch without a gap.
   */
  torque: [number, number][][];
  /**
   * The sentences of `linkwright analyze` on them, on one line.
   */
  words: string;
}
/**
 * A linkage with what loads it.
 */
export interface LoadsAsk {
  of: Source;
  /**
   * The speed of the crank, counter-clockwise, turns a minute; 0: it stands still.
   */
  rpm?: number;
  /**
   * The springs.
   */
  springs?: SpringAsk[];
  /**
   * The mass at P, kg, which gravity pulls down along -y.
   */
  weight_kg?: number;
}
/**
 * An extension spring.
 */
export interface SpringAsk {
  /**
   * Its two ends.
   *
   * @minItems 2
   * @maxItems 2
   */
  ends: [End, End];
  /**
   * The length at which it bears no force, in the drawing's unit.
   */
  free_length: number;
  /**
   * N/mm.
   */
  rate_N_per_mm: number;
}
/**
 * A saved result, opened.
 */
export interface Opened {
  ask?: Ask;
  /**
   * The candidates, better first.
   */
  candidates: Shown[];
  /**
   * Whether the target is a closed curve.
   */
  closed: boolean;
  /**
   * The names of the result's files.
   */
  files: string[];
  /**
   * The problem's name.
   */
  name: string;
  /**
   * The target points.
   */
  points: [number, number][];
  unit?: Unit;
  /**
   * The reason why it cannot, in words.
   */
  why_not?: string;
}
/**
 * A text that was read.
 */
export interface Reading {
  ask: Ask;
  /**
   * Warnings about values that are ignored or cannot succeed.
   */
  warnings: string[];
  /**
   * Whether it is a whole problem, with its requirements.
   */
  whole: boolean;
}
/**
 * A text to be read.
 */
export interface Text {
  kind: Kind;
  /**
   * Its name in messages, and that of a problem without a name.
   */
  name?: string;
  /**
   * The number of points taken along a drawing; absent: 60.
   */
  samples?: number;
  /**
   * The id of a drawing's shape; absent: the first.
   */
  svg_id?: string;
  /**
   * The text itself.
   */
  text: string;
  unit?: Unit;
}
