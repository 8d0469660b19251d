// The atlas: each case as a picture. The point under the cursor is explained beneath, and with a click at length.
import type { Case, Decision, Input, Panel, Point } from "./api";
import { type App, type Change, type View, program } from "./app";
import { briefly } from "./decision";
import { drawing, h } from "./dom";
import { failed, refused } from "./refused";

/** The value of an input at a share of its domain, in words. */
export function valueAt(input: Input, share: number): string {
  const { domain } = input;
  if (!("lo" in domain)) return input.least;
  const value = domain.lo + (domain.hi - domain.lo) * Math.min(1, Math.max(0, share));
  if (domain.kind !== "number") return String(Math.floor(value));
  // As many digits as the picture has room to tell apart.
  return String(Number(value.toPrecision(4)));
}

interface Place {
  row: Case;
  index: number;
  element: HTMLElement;
  edition: number;
  panel?: Panel;
  /** Where in the picture the point is, from 0 to 1. */
  share: [number, number];
}

export class AtlasView implements View {
  readonly id = "atlas";
  readonly title = "Atlas";
  private readonly grid = h("div.panels");
  private readonly under = h("div.under", { role: "status" }, h("p.soft", null, "Point at a picture: which case, and why."));
  readonly element = h("div.pane.atlas", null, this.grid, this.under);
  private places: Place[] = [];
  private drawn = "";
  private readonly seen: IntersectionObserver;
  private readonly visible = new Set<Element>();

  constructor(private readonly app: App) {
    this.seen = new IntersectionObserver(
      (entries) => {
        for (const { target, isIntersecting } of entries) {
          if (isIntersecting) this.visible.add(target);
          else this.visible.delete(target);
        }
        this.fill();
      },
      { root: this.element, rootMargin: "200px" },
    );
  }

  update(change: Change): void {
    if (change === "point") return;
    const found = program(this.app);
    const rows = found?.cases ?? [];
    // Panels stay where they are while cases do, so that nothing jumps while one types.
    const shape = `${found?.name} ${rows.map((row) => row.id).join(" ")}`;
    if (shape !== this.drawn) {
      this.drawn = shape;
      this.seen.disconnect();
      this.visible.clear();
      this.places = rows.map((row, index) => this.place(row, index));
      this.grid.replaceChildren(...this.places.map((place) => place.element));
      for (const place of this.places) this.seen.observe(place.element);
      if (rows.length === 0) this.grid.replaceChildren(h("p.soft", null, "There is nothing to draw."));
    }
    for (const [index, row] of rows.entries()) {
      const place = this.places[index];
      if (place) place.row = row;
    }
    this.fill();
  }

  /** Draws what is in sight and of an earlier table. */
  private fill(): void {
    if (this.app.stale) return;
    for (const place of this.places) {
      if (!this.visible.has(place.element) || place.edition === this.app.edition) continue;
      place.edition = this.app.edition;
      void this.draw(place);
    }
  }

  private async draw(place: Place): Promise<void> {
    const { compiler, program } = this.app;
    try {
      const { json } = await compiler.ask<Panel>(`panel ${place.index}`, { do: "panel", program, row: place.index });
      const reason = refused(json);
      place.panel = reason ? undefined : json;
      place.element.replaceChildren(reason ?? drawing(json.svg));
      place.element.classList.add("drawn");
    } catch (error) {
      const reason = failed(error);
      if (reason) place.element.replaceChildren(reason);
      else place.edition = -1;
    }
  }

  private place(row: Case, index: number): Place {
    const element = h("figure.panel", { tabindex: 0, "aria-label": `${program(this.app)?.function ?? `case ${row.id}`}: ${row.doc}` });
    const place: Place = { row, index, element, edition: -1, share: [0.5, 0.5] };
    element.addEventListener("pointermove", (event) => this.pointed(place, event));
    element.addEventListener("click", (event) => {
      if (this.pointed(place, event)) this.app.look(this.point(place), true);
      else this.app.reveal(place.row.at);
    });
    element.addEventListener("keydown", (event) => {
      const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (event.key === "Enter") this.app.look(this.point(place), true);
      else if (move) {
        event.preventDefault();
        const [x, y] = place.share;
        const step = event.shiftKey ? 1 / 8 : 1 / 64;
        place.share = [Math.min(1, Math.max(0, x + (move[0] ?? 0) * step)), Math.min(1, Math.max(0, y + (move[1] ?? 0) * step))];
        this.explain(place);
      }
    });
    return place;
  }

  /** Follows the cursor; true where it is over the picture. */
  private pointed(place: Place, event: MouseEvent): boolean {
    const svg = place.element.querySelector("svg");
    const shown = place.panel?.shown;
    if (!svg || !shown || !place.panel) return false;
    const box = svg.getBoundingClientRect();
    const scale = box.width / place.panel.width;
    const [left, top, width, height] = shown.place;
    const x = ((event.clientX - box.left) / scale - left) / width;
    const y = ((event.clientY - box.top) / scale - top) / height;
    const inside = x >= 0 && x <= 1 && y >= 0 && y <= 1;
    svg.classList.toggle("pointed", inside);
    if (!inside) return false;
    place.share = [x, y];
    this.explain(place);
    return true;
  }

  /** The point of a panel's picture that was pointed at. */
  private point(place: Place): Point {
    const { shown } = place.panel ?? {};
    const inputs = program(this.app)?.inputs ?? [];
    const point = { ...(shown?.point ?? {}) };
    for (const [axis, share] of [[shown?.across, place.share[0]], [shown?.down, place.share[1]]] as const) {
      const input = inputs.find((input) => input.name === axis);
      if (input) point[input.name] = valueAt(input, share);
    }
    return point;
  }

  private explain(place: Place): void {
    this.mark(place);
    const point = this.point(place);
    const { compiler, program } = this.app;
    compiler
      .ask<Decision>("pointed", { do: "explain", program, point })
      .then(({ json }) => this.under.replaceChildren(refused(json) ?? briefly(this.app, json, point)))
      .catch((error) => {
        const reason = failed(error);
        if (reason) this.under.replaceChildren(reason);
      });
  }

  /** A ring around the point, in the drawing. */
  private mark(place: Place): void {
    const svg = place.element.querySelector("svg");
    const shown = place.panel?.shown;
    if (!svg || !shown) return;
    for (const old of this.grid.querySelectorAll(".ring")) old.remove();
    const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
    const [left, top, width, height] = shown.place;
    ring.setAttribute("class", "ring");
    ring.setAttribute("cx", String(left + place.share[0] * width));
    ring.setAttribute("cy", String(top + place.share[1] * height));
    ring.setAttribute("r", "5");
    svg.append(ring);
  }
}
