// The line between the table and the views, which can be moved.
import { byId } from "./dom";

/** The least and the most of the width that the table has, in hundredths. */
const [LEAST, MOST] = [20, 80];

/** Lets the line be moved: by the pointer, or by arrows while it has the focus. */
export function divide(): void {
  const divider = byId("divider");
  const main = divider.parentElement as HTMLElement;
  const set = (share: number) => main.style.setProperty("--share", `${Math.min(MOST, Math.max(LEAST, share))}%`);
  let share = 48;
  divider.addEventListener("pointerdown", (event) => {
    divider.setPointerCapture(event.pointerId);
    divider.onpointermove = (move) => set((share = (100 * move.clientX) / main.clientWidth));
  });
  divider.addEventListener("pointerup", () => {
    divider.onpointermove = null;
  });
  divider.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -2, ArrowRight: 2 }[event.key];
    if (by) set((share = Math.min(MOST, Math.max(LEAST, share + by))));
  });
}
