// Light or dark: as the system says, or as the reader chose, which the browser remembers if it may.
import { h } from "./dom";

const CHOICES = ["auto", "light", "dark"] as const;
const LABELS = { auto: "◐", light: "☀", dark: "☾" };

function stored(): (typeof CHOICES)[number] {
  try {
    return CHOICES.find((choice) => choice === localStorage.getItem("theme")) ?? "auto";
  } catch {
    return "auto";
  }
}

/** The button that changes it. */
export function theme(): HTMLElement {
  let choice = stored();
  const button = h("button.theme", {
    id: "theme",
    click: () => {
      choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length] ?? "auto";
      try {
        localStorage.setItem("theme", choice);
      } catch {
        // A browser that keeps nothing forgets this, too.
      }
      show();
    },
  });
  const show = () => {
    document.documentElement.dataset.theme = choice;
    button.textContent = LABELS[choice];
    button.title = `Colours: ${choice === "auto" ? "as the system says" : choice}`;
    button.setAttribute("aria-label", button.title);
  };
  show();
  return button;
}
