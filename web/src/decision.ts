// The decision at a point: which case, why, and the value step by step. Every input can be set here.
import type { Decision, Input, Point, Tested } from "./api";
import { type App, type View, program } from "./app";
import { h, plural } from "./dom";
import { failed, refused } from "./refused";

/** A condition that was tested, with what decided it. */
function tested(test: Tested): HTMLElement {
  const facts = test.facts.join(", ");
  const repeats = facts === test.condition.replace(" == ", " is ");
  return h("span.test", null, h("code", null, test.condition), facts && !repeats ? h("span.soft", null, ` (${facts})`) : null);
}

/** The decision on a few lines. */
export function briefly(app: App, decision: Decision, point: Point): HTMLElement {
  const where = Object.entries(point)
    .filter(([name, value]) => program(app)?.inputs.find((input) => input.name === name)?.default !== value)
    .map(([name, value]) => `${name}=${value}`)
    .join(", ");
  const why = decision.guard?.map((test) => test.condition).join(" && ");
  return h(
    "div.brief",
    null,
    h("p.point", null, where || "everything at its default"),
    decision.needs
      ? h("p", null, "needs ", h("code", null, decision.needs), ", which is fetched and not given here")
      : h("p", null, h("strong", null, called(app, decision)), " gives ", h("strong.value", null, decision.value), why ? [", as ", h("code", null, why)] : ""),
  );
}

/** Whoever gives the value: a case, the default, or a function, which has no cases. */
const called = (app: App, { case: taken }: Decision) => program(app)?.function ?? (taken ? `case ${taken.id}` : "the default");

export class DecisionView implements View {
  readonly id = "decision";
  readonly title = "Decision";
  private readonly inputs = h("div.inputs");
  private readonly answer = h("div.answer", { role: "status" });
  private readonly examples = h<HTMLSelectElement>("select", {
    "aria-label": "Points of the table's examples",
    change: () => {
      const example = program(this.app)?.examples[Number(this.examples.value)];
      if (example) this.app.look(example.point);
    },
  });
  readonly element = h(
    "div.pane.decision",
    null,
    h("div.controls", null, h("label", null, "Point ", this.examples)),
    h("div.columns", null, this.inputs, this.answer),
  );
  private formed = "";
  private readonly fields = new Map<string, HTMLInputElement | HTMLSelectElement>();

  constructor(private readonly app: App) {}

  update(): void {
    const found = program(this.app);
    if (!found) {
      this.answer.replaceChildren(h("p.soft", null, "There is no table to decide by."));
      return;
    }
    const shape = JSON.stringify([found.name, found.inputs, found.examples.length]);
    if (shape !== this.formed) {
      this.formed = shape;
      this.form(found.inputs);
      const option = (text: string, value: string) => h("option", { value }, text);
      this.examples.replaceChildren(
        option("of an example …", ""),
        ...found.examples.map((example, index) => {
          const row = found.cases[example.row];
          return option(found.function ? `example ${index + 1}` : `case ${row?.id}, example ${index + 1}`, String(index));
        }),
      );
    }
    for (const [name, field] of this.fields) {
      const input = found.inputs.find((one) => one.name === name);
      const value = this.app.point[name] ?? (input?.fetched == null ? input?.least : "") ?? "";
      if (field.value !== value && document.activeElement !== field) field.value = value;
      const slider = field.parentElement?.querySelector<HTMLInputElement>("input[type=range]");
      if (slider && document.activeElement !== slider) slider.value = value;
    }
    void this.decide();
  }

  private form(inputs: Input[]): void {
    this.fields.clear();
    const rows = (fetched: boolean) => inputs.filter((input) => (input.fetched != null) === fetched).map((input) => this.row(input));
    const fetched = rows(true);
    this.inputs.replaceChildren(...rows(false), ...(fetched.length > 0 ? [h("h3", null, "Fetched, where needed"), ...fetched] : []));
  }

  private set(input: Input, value: string): void {
    const point = { ...this.app.point };
    if (value === "") delete point[input.name];
    else point[input.name] = value;
    this.examples.value = "";
    this.app.look(point);
  }

  private row(input: Input): HTMLElement {
    const { domain } = input;
    const id = `input-${input.name}`;
    const label = h("label", { for: id, title: input.doc }, input.name);
    if (!("lo" in domain)) {
      const options = domain.levels.map((level) => h("option", { value: level }, level));
      if (input.fetched != null) options.unshift(h("option", { value: "" }, "not given"));
      const field = h<HTMLSelectElement>("select", { id, change: () => this.set(input, field.value) }, options);
      this.fields.set(input.name, field);
      return h("div.input", null, label, h("span.field", null, field));
    }
    const field = h<HTMLInputElement>("input", {
      id,
      type: "text",
      inputmode: "decimal",
      placeholder: input.fetched != null ? "not given" : null,
      input: () => this.set(input, field.value.trim()),
    });
    this.fields.set(input.name, field);
    const slider =
      domain.kind === "number" &&
      h<HTMLInputElement>("input", {
        type: "range",
        min: domain.lo,
        max: domain.hi,
        step: (domain.hi - domain.lo) / 1024,
        "aria-label": input.name,
        input: (event: Event) => this.set(input, (event.target as HTMLInputElement).value),
      });
    return h("div.input", null, label, h("span.field", null, field, slider));
  }

  private async decide(): Promise<void> {
    if (this.app.stale) return;
    const { compiler, program, point } = this.app;
    try {
      const { json } = await compiler.ask<Decision>("decision", { do: "explain", program, point });
      this.answer.replaceChildren(refused(json) ?? this.told(json));
    } catch (error) {
      const reason = failed(error);
      if (reason) this.answer.replaceChildren(reason);
    }
  }

  private told(decision: Decision): HTMLElement {
    const { app } = this;
    if (decision.needs) {
      const name = decision.needs;
      const focus = () => this.fields.get(name)?.focus();
      const by = decision.by == null ? "the default" : `case ${decision.by}`;
      return h("div", null, h("p", null, by, " needs ", h("button.link", { click: focus }, name), ", which the host would fetch. Give it a value."));
    }
    const taken = decision.case;
    const to = (at: [number, number], text: string) => h("button.link", { click: () => app.reveal(at), title: "Show it in the table" }, text);
    return h(
      "div",
      null,
      h("p.result", null, h("span.value", null, decision.value)),
      taken
        ? h("p", null, to(taken.at, called(app, decision)), taken.doc && `: ${taken.doc}`, taken.section && h("span.soft", null, ` (section ${taken.section})`))
        : h("p", null, "No case matches: the default counts."),
      decision.also.length > 0 && h("p", null, `Then the items of case ${decision.also.join(", ")}.`),
      decision.guard.length > 0 && [h("h3", null, "Why"), h("ul", null, decision.guard.map((test) => h("li", null, tested(test))))],
      taken && taken.lines > 1 && [
        h("h3", null, "Its lines, in order"),
        h(
          "ol",
          null,
          decision.refused_lines.map((test) => h("li.no", null, "no: ", tested(test))),
          decision.line
            ? h("li.yes", null, to(decision.line.at, "yes"), decision.line_condition.length > 0 ? ": " : ", it has no condition", decision.line_condition.map(tested))
            : h("li", null, "none applies: the default counts"),
        ),
      ],
      decision.steps.length > 0 && [
        h("h3", null, "Value, step by step"),
        h(
          "div.wide",
          null,
          h(
            "table.steps",
            null,
            decision.steps.map((step) =>
              h(
                "tr",
                null,
                h("th", null, step.name),
                h("td", null, "= ", step.formula),
                h("td", null, step.numbers ? `= ${step.numbers}` : ""),
                h("td", null, step.value !== step.formula ? `= ${step.value}` : ""),
                h("td.soft", null, step.because ?? ""),
              ),
            ),
          ),
        ),
      ],
      decision.fetched.length > 0 && h("p", null, "Fetched: ", decision.fetched.join(", "), ` (${decision.cost} texture reads)`),
      decision.refused.length > 0 &&
        h(
          "details",
          null,
          h("summary", null, `${plural(decision.refused.length, "case")} passed over before it`),
          h("ol.passed", null, decision.refused.map((one) => h("li", null, to(one.at, `case ${one.case}`), " as this fails: ", tested(one.fails)))),
        ),
    );
  }
}

