// The elements of the page by their ids.

export const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
export const input = (id: string) => byId<HTMLInputElement>(id);
