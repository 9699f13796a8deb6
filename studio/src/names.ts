// Names of problems, which become names of files and folders: what the studio takes.

/** Names of devices on Windows: no file can be called so there, with or without an ending. */
const DEVICES = /^(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[0-9\u00b9\u00b2\u00b3])\s*(\.|$)/i;
const MOST = 64;

/** Why a text is no name; null: it is one. */
export function nameFault(name: string): string | null {
  if (name.trim() === "") return "A name has at least one letter";
  if ([...name].length > MOST) return `A name has at most ${MOST} letters`;
  const other = name.match(/[^\p{L}\p{N} ._-]/u);
  if (other) return `A name has letters, digits, blanks and - _ . in it, and no ${other[0]}`;
  if (/^[.-]/.test(name)) return `A name does not begin with ${name[0]}`;
  if (name.endsWith(".")) return "A name does not end with a dot";
  if (DEVICES.test(name)) return `${name} is the name of a device on Windows`;
  return null;
}
