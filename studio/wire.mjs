#!/usr/bin/env node
// The types of what the studio and the page say to each other, from the studio's own descriptions in docs/: writes
// src/wire.ts, or with --check says whether it is what they give. Needs `npm ci` before.

import { readFileSync, writeFileSync } from "node:fs";
import { compile } from "json-schema-to-typescript";

const read = (name) => JSON.parse(readFileSync(new URL(`../docs/${name}`, import.meta.url), "utf8"));
const messages = read("studio-messages.json");
const { schemas } = read("studio-openapi.json").components;

/** All definitions by their names, each reference in one form. */
const all = {};
for (const [name, { $defs = {}, ...schema }] of Object.entries(messages)) Object.assign(all, $defs, { [name]: schema });
Object.assign(all, schemas);
const rest = (value) => {
  if (Array.isArray(value)) return value.map(rest);
  if (value === null || typeof value !== "object") return value;
  // What stands beside a reference would make a type of its own of it.
  if (value.$ref) return { $ref: value.$ref.replace("#/components/schemas/", "#/$defs/") };
  // What may be missing is never null: it is left out.
  if (value.anyOf?.length === 2 && value.anyOf[1].type === "null") return rest(value.anyOf[0]);
  const out = {};
  for (const [key, one] of Object.entries(value)) {
    // Titles name types a second time; formats say nothing to TypeScript.
    if (["$schema", "title", "format"].includes(key) && typeof one === "string") continue;
    out[key] = key === "type" && Array.isArray(one) && one[1] === "null" ? one[0] : rest(one);
  }
  return out;
};
const definitions = Object.fromEntries(Object.entries(rest(all)).sort(([one], [other]) => (one < other ? -1 : 1)));
const root = {
  type: "object",
  properties: Object.fromEntries(Object.keys(definitions).map((name) => [name, { $ref: `#/$defs/${name}` }])),
  required: Object.keys(definitions),
  additionalProperties: false,
  $defs: definitions,
};
const text = await compile(root, "Wire", {
  additionalProperties: false,
  bannerComment:
    "// Made by studio/wire.mjs from docs/studio-messages.json and docs/studio-openapi.json: not to be changed by hand.",
  unreachableDefinitions: false,
  maxItems: 8,
  style: { printWidth: 120 },
});
const file = new URL("src/wire.ts", import.meta.url);
if (process.argv.includes("--check")) {
  if (readFileSync(file, "utf8") !== text) {
    console.error("studio/src/wire.ts is not what docs/ describe: run studio/wire.mjs");
    process.exit(1);
  }
} else writeFileSync(file, text);
