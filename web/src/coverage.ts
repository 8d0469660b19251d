// Coverage: every state as a square in the colour of the case that it leads to.
import type { Matrix, Point } from "./api";
import { type App, type Change, type View, program } from "./app";
import { drawing, h } from "./dom";
import { failed, refused } from "./refused";

export class Coverage implements View {
  readonly id = "coverage";
  readonly title = "Coverage";
  readonly element = h("div.pane.coverage");
  private shown = "";

  constructor(private readonly app: App) {
    this.element.addEventListener("click", (event) => {
      const square = (event.target as Element).closest("[data-state]");
      if (!square) return;
      event.preventDefault();
      void this.decide(Number(square.getAttribute("data-state")));
    });
  }

  update(change: Change): void {
    const wanted = `${this.app.edition} ${this.app.program}`;
    if (change === "point" || this.app.stale || wanted === this.shown) return;
    this.shown = wanted;
    void this.draw();
  }

  private async draw(): Promise<void> {
    const found = program(this.app);
    if (!found || found.function) {
      this.element.replaceChildren(h("p.soft", null, "Only a table of cases has states to cover."));
      return;
    }
    try {
      const { json } = await this.app.compiler.ask<Matrix>("matrix", { do: "matrix", program: this.app.program });
      this.element.replaceChildren(refused(json) ?? drawing(json.html));
      for (const link of this.element.querySelectorAll("a")) link.removeAttribute("href");
    } catch (error) {
      this.shown = "";
      const reason = failed(error);
      if (reason) this.element.replaceChildren(reason);
    }
  }

  /** Looks at a point of a state. */
  private async decide(state: number): Promise<void> {
    const { compiler, program } = this.app;
    try {
      const { json } = await compiler.ask<{ point?: Point }>("state", { do: "state", program, state });
      if (json.point) this.app.look(json.point, true);
    } catch (error) {
      const reason = failed(error);
      if (reason) this.element.prepend(reason);
    }
  }
}
