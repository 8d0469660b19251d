// Run: the emitted shader on the device over the pixels of a picture, beside the interpreter's picture and their difference.
import type { Case, Input, Panel, Piece, Point, Run, Verdict } from "./api";
import { type App, type Change, type View, program } from "./app";
import { valueAt } from "./atlas";
import { type Api, available, run } from "./device";
import { h, plural } from "./dom";
import { failed, refused } from "./refused";

const bytes = (of: Uint8Array<ArrayBuffer>, piece: Piece) => of.slice(piece[0], piece[0] + piece[1]);
const words = (of: Uint8Array<ArrayBuffer>, piece: Piece) => new Uint32Array(bytes(of, piece).buffer);

/** Verdicts by their number, in colours that differ in lightness, too. */
const VERDICTS = [
  { name: "the same bits", colour: [43, 49, 58] },
  { name: "legal: WGSL leaves room", colour: [90, 170, 225] },
  { name: "legal: sums in another order", colour: [230, 190, 60] },
  { name: "wrong", colour: [226, 61, 40] },
  { name: "not asked: an assumption fails", colour: [120, 120, 120] },
] as const;

interface Axes {
  point: Point;
  across: string;
  down: string;
}

export class RunView implements View {
  readonly id = "run";
  readonly title = "Run";
  private readonly plan = this.select("run-plan");
  private readonly over = this.select("run-over");
  private readonly across = this.select("run-across");
  private readonly down = this.select("run-down");
  private readonly side = this.select("run-side");
  private readonly api = this.select("run-api");
  private readonly pictures = ["interpreter", "device", "difference"].map((name) => {
    const canvas = h<HTMLCanvasElement>("canvas", { width: 1, height: 1, role: "img", "aria-label": `picture of the ${name}` });
    canvas.addEventListener("click", (event) => this.pointed(canvas, event));
    return { canvas, element: h("figure", null, canvas, h("figcaption", null, name)) };
  });
  private readonly verdict = h("div.verdict", { role: "status" });
  readonly element = h(
    "div.pane.run",
    null,
    h(
      "div.controls",
      null,
      h("label", null, "Plan ", this.plan),
      h("label", null, "Around ", this.over),
      h("label", null, "Across ", this.across),
      h("label", null, "Down ", this.down),
      h("label", null, "Pixels ", this.side),
      h("label", null, "On ", this.api),
    ),
    h("div.pictures", null, this.pictures.map(({ element }) => element)),
    this.verdict,
  );
  private formed = "";
  private shown = "";
  private axes?: Axes;
  private apis?: Api[];
  /** Counts runs; what an earlier one still brings is not shown. */
  private turn = 0;

  constructor(private readonly app: App) {}

  private select(id: string): HTMLSelectElement {
    return h<HTMLSelectElement>("select", { id, change: () => this.changed(id) });
  }

  private changed(id: string): void {
    if (id === "run-over") void this.settle().then(() => this.run());
    else void this.run();
  }

  update(change: Change): void {
    const found = program(this.app);
    const { choices } = this.app;
    if (!choices || this.app.stale) return;
    if (!found) {
      this.verdict.replaceChildren(h("p.soft", null, "The table declares things for others; there is nothing to run."));
      return;
    }
    const option = (value: string, text = value) => h("option", { value }, text);
    if (this.plan.options.length === 0) {
      this.plan.replaceChildren(...choices.plans.map(({ name }) => option(name)));
      this.plan.value = "ordered";
      this.side.replaceChildren(...["32", "64", "128", "256"].map((side) => option(side, `${side} × ${side}`)));
      this.side.value = "128";
    }
    const numbers = found.inputs.filter(({ domain }) => domain.kind === "number" || domain.kind === "word");
    const shape = JSON.stringify([found.name, numbers, found.cases.map(({ id, doc }) => [id, doc])]);
    const same = shape === this.formed;
    if (!same) {
      this.formed = shape;
      const axis = [option("", "–"), ...numbers.map(({ name }) => option(name))];
      this.across.replaceChildren(...axis);
      this.down.replaceChildren(...axis.map((one) => one.cloneNode(true)));
      const cases = found.function ? [] : found.cases.map(({ id, doc }, index) => option(String(index), `case ${id}${doc && `: ${doc.slice(0, 60)}`}`));
      this.over.replaceChildren(option("point", "the point of the decision"), ...cases);
      this.over.value = cases.length > 0 ? String(this.telling(found.cases)) : "point";
    }
    if (change === "point" && this.over.value !== "point") return;
    const wanted = `${this.app.edition} ${this.app.program} ${this.over.value === "point" ? JSON.stringify(this.app.point) : ""}`;
    if (wanted === this.shown) return;
    this.shown = wanted;
    void this.settle(same && this.axes !== undefined).then(() => this.run());
  }

  /** The case at the cursor, or else the one with the most lines, where there is most to see. */
  private telling(cases: Case[]): number {
    const cursor = this.app.editor.view.state.selection.main.head;
    const here = cases.findIndex(({ at }) => at[0] <= cursor && cursor <= at[1]);
    const most = cases.reduce((best, { lines }, index) => (lines > (cases[best]?.lines ?? 0) ? index : best), 0);
    return here >= 0 ? here : most;
  }

  /** Finds the point and the axes: those of a case's picture, or the point of the decision. */
  private async settle(keep = false): Promise<void> {
    const inputs: Input[] = program(this.app)?.inputs ?? [];
    const isNumber = ({ domain }: Input) => domain.kind === "number" || domain.kind === "word";
    const numbers = inputs.filter((input) => isNumber(input) && input.fetched == null).map(({ name }) => name);
    let point = this.app.point;
    let [across, down] = [numbers[0] ?? "", numbers[1] ?? ""];
    if (this.over.value !== "point") {
      const row = Number(this.over.value);
      const asked = { do: "panel", program: this.app.program, row };
      const { json } = await this.app.compiler.ask<Panel>("run panel", asked).catch(() => ({ json: undefined }));
      if (json?.shown) {
        point = json.shown.point;
        [across, down] = [json.shown.across ?? "", json.shown.down ?? ""];
      }
    }
    this.axes = { point, across, down };
    if (keep) return;
    this.across.value = across;
    this.down.value = down;
  }

  private async run(): Promise<void> {
    const { compiler } = this.app;
    const turn = ++this.turn;
    const isOver = () => turn !== this.turn;
    if (!this.apis) {
      this.apis = await available();
      this.api.replaceChildren(...this.apis.map((api) => h("option", { value: api }, api)));
    }
    // Without an axis every pixel is the same point.
    const side = this.across.value || this.down.value ? Number(this.side.value) : 1;
    const asked = {
      program: this.app.program,
      plan: this.plan.value,
      point: this.axes?.point ?? {},
      across: this.across.value,
      down: this.down.value,
      side,
    };
    this.element.classList.add("waiting");
    try {
      const { json, bytes: pieces } = await compiler.ask<Run>("run", { ...asked, do: "run" });
      if (isOver()) return;
      const reason = refused(json);
      if (reason) {
        this.clear(reason);
        return;
      }
      this.paint(0, side, bytes(pieces, json.pixels));
      if (this.apis.length === 0) {
        this.clear(h("p", null, "This browser offers neither WebGPU nor WebGL 2; the interpreter's picture stands alone."), 1);
        return;
      }
      const ran = await run(this.api.value as Api, json, {
        plain: words(pieces, json.plain),
        ...(json.fetched && { fetched: words(pieces, json.fetched) }),
        ...(json.lookup && { lookup: words(pieces, json.lookup) }),
      });
      if (isOver()) return;
      const judged = await compiler.ask<Verdict>("judge", { ...asked, do: "judge" }, new Uint8Array(ran.words.buffer));
      if (isOver()) return;
      const refusal = refused(judged.json);
      if (refusal) {
        this.clear(refusal, 1);
        return;
      }
      this.paint(1, side, bytes(judged.bytes, judged.json.pixels));
      const marks = bytes(judged.bytes, judged.json.marks);
      const colours = new Uint8ClampedArray(4 * marks.length);
      marks.forEach((mark, at) => colours.set([...(VERDICTS[mark]?.colour ?? [0, 0, 0]), 255], 4 * at));
      this.paint(2, side, colours);
      this.tell(judged.json, `${ran.api}${ran.device ? `, ${ran.device}` : ""}`, ran.took);
    } catch (error) {
      const reason = failed(error);
      if (reason && !isOver()) this.clear(reason, 1);
    } finally {
      if (!isOver()) this.element.classList.remove("waiting");
    }
  }

  private paint(which: number, side: number, pixels: ArrayLike<number>): void {
    const canvas = this.pictures[which]?.canvas;
    const context = canvas?.getContext("2d");
    if (!canvas || !context) return;
    canvas.width = canvas.height = side;
    const picture = context.createImageData(side, side);
    picture.data.set(pixels);
    context.putImageData(picture, 0, 0);
  }

  private clear(reason: HTMLElement, from = 0): void {
    for (let which = from; which < 3; which++) this.paint(which, 1, [0, 0, 0, 0]);
    this.verdict.replaceChildren(reason);
  }

  private tell(verdict: Verdict, device: string, took: number): void {
    const counts = [verdict.equal, verdict.admissible, verdict.reordered, verdict.offending, verdict.excluded];
    const all = counts.reduce((sum, count) => sum + count, 0);
    this.verdict.replaceChildren(
      h(
        "p",
        null,
        verdict.offending === 0 ? h("span.ok", null, "✓ ") : h("span.bad", null, "✗ "),
        `${plural(all, "point")} on ${device}, ${took.toFixed(1)} ms: `,
        verdict.offending === 0 ? "the device agrees with the table" : `${verdict.offending} wrong`,
        ".",
      ),
      h(
        "ul.legend",
        null,
        counts.map((count, at) =>
          count > 0 && h("li", null, h("span.swatch", { style: `background: rgb(${VERDICTS[at]?.colour.join(" ")})` }), `${count} ${VERDICTS[at]?.name}`),
        ),
      ),
      ...(verdict.worst ? [h("p.soft", null, `Largest difference of a value: ${verdict.worst.toPrecision(3)}`)] : []),
      ...verdict.offenders.map(({ inputs, reason }) => h("p.refused", null, h("code", null, inputs), ` ${reason}`)),
      h("p.soft", null, "Click a picture for the decision there. Fetched inputs that the point does not give have their default or first level."),
    );
  }

  /** Looks at the point of a pixel. */
  private pointed(canvas: HTMLCanvasElement, event: MouseEvent): void {
    const inputs = program(this.app)?.inputs ?? [];
    const box = canvas.getBoundingClientRect();
    const point = { ...this.axes?.point };
    const pixel = (share: number) => (Math.floor(share * canvas.width) + 0.5) / canvas.width;
    const shares = [pixel((event.clientX - box.left) / box.width), pixel((event.clientY - box.top) / box.height)];
    for (const [axis, share] of [[this.across.value, shares[0]], [this.down.value, shares[1]]] as const) {
      const input = inputs.find(({ name }) => name === axis);
      if (input && share !== undefined) point[input.name] = valueAt(input, share);
    }
    this.app.look(point, true);
  }
}
