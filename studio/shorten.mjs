// Makes a minified script and a page shorter still without changing what they do.
//
// What a script repeats (members that nobody may rename such as addEventListener, words in quotes, functions of Math) is
// written once, at its beginning, and stands everywhere else as a variable of two letters.

import ts from "typescript";

/** Objects whose functions need no `this`. */
const SPACES = new Set(["Math", "Number", "JSON", "Object"]);
/** Shorter members stay, and `length`: loops read them, and a name is found faster than what a variable names. */
const LEAST_MEMBER = 6;

/** A space where a variable would run into the word that stands at a place. */
const apart = (text, at) => (/[\w$]/.test(text[at]) ? " " : "");

/** What may be repeated in a script, and the places where it stands, each with what is written around a variable there. */
function places(script) {
  const file = ts.createSourceFile("app.js", script, ts.ScriptTarget.ES2022, true, ts.ScriptKind.JS);
  const found = new Map();
  const note = (value, from, to, before = "", after = "") => {
    const all = found.get(value) ?? [];
    all.push({ from, to, before, after });
    found.set(value, all);
  };
  const visit = (node) => {
    if (ts.isPropertyAccessExpression(node) && ts.isIdentifier(node.name)) {
      const { expression, name, questionDotToken } = node;
      const from = expression.end;
      if (ts.isIdentifier(expression) && SPACES.has(expression.text) && !questionDotToken)
        note(`${expression.text}.${name.text}`, expression.getStart(), node.end);
      else if (
        name.text.length >= LEAST_MEMBER &&
        name.text !== "length" &&
        expression.kind !== ts.SyntaxKind.SuperKeyword
      )
        note(JSON.stringify(name.text), from, node.end, questionDotToken ? "?.[" : "[", "]");
    } else if (ts.isStringLiteral(node) && !ts.isExpressionStatement(node.parent)) {
      const from = node.getStart();
      if (node.parent.name === node) note(node.getText(), from, node.end, "[", "]");
      else note(node.getText(), from, node.end, apart(script, from - 1), apart(script, node.end));
    }
    ts.forEachChild(node, visit);
  };
  visit(file);
  return found;
}

/** Names of two letters that a script has not. */
function* free(script) {
  const letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_$";
  const firsts = `$_${letters.replace(/[\d$_]/g, "")}`;
  for (const first of firsts) for (const second of letters) if (!script.includes(first + second)) yield first + second;
}

/** A script that is one function, `"use strict";(()=>{...})();`, with what it repeats written once. */
export function shortenScript(script) {
  const head = /^("use strict";)?\(\(\)=>\{/.exec(script)?.[0];
  if (!head) throw new Error("the script is not one function");
  const names = free(script);
  const gains = [...places(script)].map(([value, all]) => {
    const less = all.map(({ from, to, before, after }) => to - from - `${before}$a${after}`.length);
    return { value, all, gain: less.reduce((sum, one) => sum + one, 0) - `$a=${value},`.length };
  });
  const chosen = gains.filter(({ gain }) => gain > 0).sort((one, other) => other.gain - one.gain);
  const [begun, changes] = [[], []];
  for (const { value, all } of chosen) {
    const { value: name, done } = names.next();
    if (done) break;
    begun.push(`${name}=${value}`);
    for (const { from, to, before, after } of all) changes.push({ from, to, text: before + name + after });
  }
  changes.sort((one, other) => other.from - one.from);
  let short = script;
  for (const { from, to, text } of changes) short = short.slice(0, from) + text + short.slice(to);
  return begun.length > 0 ? `${head}var ${begun.join(",")};${short.slice(head.length)}` : short;
}

/** A page without the line breaks between its tags, which no words are parted by, and without quotes that need not be. */
export const shortenPage = (page) =>
  page
    .replace(/>\s*\n\s*</g, "><")
    .replace(/<[a-z][^>]*>/g, (tag) => tag.replace(/="([\w-]+)"/g, "=$1"))
    .trimEnd();
