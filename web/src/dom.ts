// Elements by one call. Texts of tables become text nodes, never markup.

type Child = Node | string | number | null | undefined | false | Child[];
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

function append(to: Node, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) append(to, child);
    else if (child instanceof Node) to.appendChild(child);
    else if (child !== null && child !== undefined && child !== false) to.appendChild(document.createTextNode(String(child)));
  }
}

/** An element, such as `h("p.soft", { title }, "text")`. Functions among the attributes listen. */
export function h<E extends HTMLElement = HTMLElement>(selector: string, attributes?: Attributes | null, ...children: Child[]): E {
  const [name, ...classes] = selector.split(".");
  const element = document.createElement(name || "div") as unknown as E;
  if (classes.length > 0) element.className = classes.join(" ");
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (typeof value === "function") element.addEventListener(key, value as EventListener);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(key, String(value));
  }
  append(element, children);
  return element;
}

/** The element of the page with an id. */
export function byId<E extends HTMLElement = HTMLElement>(id: string): E {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as E;
}

/** A drawing that the compiler made, as an element; scripts in it would not run, and the page's policy forbids them anyway. */
export function drawing(markup: string): DocumentFragment {
  const template = document.createElement("template");
  template.innerHTML = markup;
  return template.content;
}

export function plural(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

let hiding = 0;

/** Says something that needs no answer, for a few seconds. */
export function toast(text: string): void {
  const at = byId("toast");
  at.textContent = text;
  at.classList.add("on");
  clearTimeout(hiding);
  hiding = window.setTimeout(() => at.classList.remove("on"), 5000);
}

/** Waits until calls have ceased for a while. */
export function calm<A extends unknown[]>(wait: number, call: (...args: A) => void): (...args: A) => void {
  let timer = 0;
  return (...args) => {
    clearTimeout(timer);
    timer = window.setTimeout(() => call(...args), wait);
  };
}
