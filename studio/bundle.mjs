#!/usr/bin/env node
// Makes the page in the folder that is named, as short as it can be: app.js of src/main.ts, style.css of the player's and
// the studio's styles, index.html of src/index.html; more.js of src/more.ts and more.css, which the page loads when they are
// first needed.
//
// Members of classes get short names where every use of the name in the page is one of a class's member, as the types say:
// what is sent, kept or read from outside keeps its name. So do the styles' own properties, which no script names.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build, transform } from "esbuild";
import ts from "typescript";
import { shortenPage, shortenScript } from "./shorten.mjs";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** The files of the page, with what their names mean. */
function program() {
  const { config } = ts.readConfigFile(here("tsconfig.json"), ts.sys.readFile);
  const { fileNames, options } = ts.parseJsonConfigFileContent(config, ts.sys, here("."));
  return ts.createProgram(fileNames, { ...options, noEmit: true });
}

/** Files whose interfaces lie between parts of the page: what has them is neither sent nor kept. */
const INSIDE = [
  "angles",
  "bodies",
  "board",
  "boxes",
  "build",
  "buildtab",
  "byhand",
  "controls",
  "desk",
  "examples",
  "exchange",
  "grab",
  "graph",
  "kit",
  "motion",
  "pinmap",
  "pointers",
  "scene",
  "slides",
  "store",
  "strip",
  "surface",
  "words",
];
const isInside = (file) => INSIDE.some((name) => file.fileName.endsWith(`/studio/src/${name}.ts`));

/** Whether all that a symbol stands for are members of our own classes, or of such interfaces. */
const isMember = (symbol) =>
  symbol?.declarations?.length > 0 &&
  symbol.declarations.every(
    (one) =>
      !one.getSourceFile().isDeclarationFile &&
      (ts.isClassLike(one.parent) ||
        (ts.isTypeElement(one) && isInside(one.getSourceFile())) ||
        (ts.isParameter(one) && ts.isConstructorDeclaration(one.parent)) ||
        (ts.isPropertyAccessExpression(one) && one.expression.kind === ts.SyntaxKind.ThisKeyword)),
  );

/** The symbol that a name of a property means; undefined where the types do not tell. */
function meaning(checker, name) {
  const { parent } = name;
  if (
    ts.isBindingElement(parent) &&
    ts.isObjectBindingPattern(parent.parent) &&
    (parent.propertyName ?? parent.name) === name
  )
    return checker.getTypeAtLocation(parent.parent).getProperty(name.text);
  // A literal that is made for a type has the type's members.
  if (ts.isObjectLiteralElement(parent) && ts.isObjectLiteralExpression(parent.parent)) {
    const meant = checker.getContextualType(parent.parent)?.getProperty(name.text);
    if (meant) return meant;
  }
  return checker.getSymbolAtLocation(name);
}

/** Whether a node stands where a property is named. */
function isProperty(node) {
  const { parent } = node;
  if (ts.isPropertyAccessExpression(parent)) return parent.name === node;
  if (ts.isBindingElement(parent))
    return ts.isObjectBindingPattern(parent.parent) && (parent.propertyName ?? parent.name) === node;
  if (ts.isParameter(parent)) return ts.isParameterPropertyDeclaration(parent, parent.parent) && parent.name === node;
  if (ts.isShorthandPropertyAssignment(parent)) return true;
  return (
    (ts.isClassElement(parent) || ts.isTypeElement(parent) || ts.isObjectLiteralElement(parent)) && parent.name === node
  );
}

/** The names that members of classes alone have. */
function names() {
  const whole = program();
  const checker = whole.getTypeChecker();
  const [members, others] = [new Set(), new Set(["constructor"])];
  const visit = (node) => {
    // A name in quotes or in brackets is one too.
    if (ts.isStringLiteralLike(node) && isProperty(node)) others.add(node.text);
    else if (ts.isElementAccessExpression(node)) {
      const key = checker.getTypeAtLocation(node.argumentExpression);
      for (const one of key.isUnion() ? key.types : [key]) if (one.isStringLiteral()) others.add(one.value);
    } else if (ts.isIdentifier(node) && isProperty(node))
      (isMember(meaning(checker, node)) ? members : others).add(node.text);
    ts.forEachChild(node, visit);
  };
  for (const file of whole.getSourceFiles()) if (!file.isDeclarationFile) visit(file);
  return [...members].filter((name) => !others.has(name)).sort();
}

const common = { target: "es2022", charset: "utf8", minify: true, logLevel: "warning" };
const folder = process.argv[2];

const mangleProps = new RegExp(`^(${names().join("|")})$`);
/** The short names of members: what one script hands to the other has one name in both. */
let mangleCache = {};
for (const [name, entry] of [
  ["app.js", "src/main.ts"],
  ["more.js", "src/more.ts"],
]) {
  const built = await build({
    ...common,
    entryPoints: [here(entry)],
    write: false,
    bundle: true,
    format: "iife",
    mangleProps,
    mangleCache,
  });
  ({ mangleCache } = built);
  writeFileSync(join(folder, name), shortenScript(built.outputFiles[0].text));
}
writeFileSync(join(folder, "index.html"), shortenPage(readFileSync(here("src/index.html"), "utf8")));

const styles = ["../src/report/html/player/player.css", "src/studio.css", "src/desk.css"];
const css = styles.map((name) => readFileSync(here(name), "utf8")).join("");
const properties = [...new Set(css.match(/--[a-z][\w-]*/g))];
for (const [name, text] of [
  ["style.css", css],
  ["more.css", readFileSync(here("src/more.css"), "utf8")],
]) {
  const short = text
    .replace(/--[a-z][\w-]*/g, (property) => `--${properties.indexOf(property).toString(36)}`)
    .replace(/(--\w+:) +/g, "$1")
    .replace(/#([\da-f])\1([\da-f])\2([\da-f])\3(?![\da-f])/g, "#$1$2$3");
  writeFileSync(join(folder, name), (await transform(short, { ...common, loader: "css" })).code);
}
