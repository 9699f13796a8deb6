// What the page asks of the studio over HTTP: see /openapi.json.

import type { Reading, Shown, Solution, Task } from "./messages";
import type { Compared, Details, JobList, JobShown, Loaded, LoadsAsk, Opened, Source } from "./wire";

export type { Compared, Details, JobList, JobShown, Opened, Source };

/** An answer that is not what was asked for, in the studio's words. */
export class Refused extends Error {}

async function answered(path: string, body?: unknown): Promise<Response> {
  let reply: Response;
  try {
    reply = await fetch(
      path,
      body === undefined
        ? {}
        : { method: "POST", body: JSON.stringify(body), headers: { "Content-Type": "application/json" } },
    );
  } catch {
    throw new Refused("the studio does not answer");
  }
  if (!reply.ok) throw new Refused((await reply.text()).trim());
  return reply;
}

export const jobs = async () => (await answered("/jobs")).json() as Promise<JobList>;
export const start = async (ask: unknown) => (await answered("/jobs", ask)).json() as Promise<JobShown>;
const at = (name: string) => `/jobs/${encodeURIComponent(name)}`;
export const cancel = (name: string) => answered(`${at(name)}/cancel`, null);
export const resume = (name: string) => answered(`${at(name)}/resume`, null);
export const open = async (name: string) => (await answered(`${at(name)}/opened`)).json() as Promise<Opened>;
export const details = async (of: Source) => (await answered("/details", { of })).json() as Promise<Details>;
export const loaded = async (ask: LoadsAsk) => (await answered("/loads", ask)).json() as Promise<Loaded>;
export const judged = async (ask: Task, linkage: Shown["linkage"]) =>
  (await answered("/judged", { ask, linkage })).json() as Promise<Shown>;
export const exported = async (
  of: Source,
  format: string,
  more: { set?: Record<string, string>; name?: string } = {},
) => (await answered("/export", { of, format, ...more })).blob();
export const compared = async (of: Source[]) => (await answered("/compare", { of })).json() as Promise<Compared>;
export const comparedAs = async (of: Source[], form: string) => (await answered("/compare", { of, form })).blob();
export const read = async (text: { kind: string; name: string; text: string; unit?: string; samples?: number }) =>
  (await answered("/read", text)).json() as Promise<Reading>;
/** A linkage as it stands, as a source of details, files and comparisons. */
export function drawn({ shown: { linkage, crank_deg, t1_at }, task }: Solution): Source {
  return { drawn: { ask: task, linkage, crank_deg, t1_at } };
}
export const beginning = async () => (await answered("/beginning.json")).text();
export const linkageOf = async (name: string, { shown, task }: Solution) =>
  (await answered("/linkage.toml", { name, unit: task.unit, linkage: shown.linkage })).text();
export const problemOf = async (task: Task) => (await answered("/problem.toml", { ...task, version: 0 })).text();

/** Why the studio gives this tab no connection, in words. */
export async function whyClosed(): Promise<string> {
  try {
    const reply = await fetch("/beginning.json");
    if (reply.ok)
      return "The studio answers, but serves no more tabs at once: close another one, and this one goes on.";
    if (reply.status === 401 || reply.status === 403)
      return "Another studio answers here, which does not know this tab: open the address that it printed (Enter in its terminal prints another); your drawing is kept here.";
  } catch {
    // It has ended.
  }
  return "The studio does not answer. Start it again with `linkwright studio` and open the address that it prints; your drawing is kept here.";
}

/** Saves a file where the browser saves files. */
export function saved(what: Blob, name: string) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(what);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export const wordsOf = (error: unknown) => (error instanceof Refused ? error.message : String(error));
