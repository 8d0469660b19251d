// The beginning: what is in the page is painted first, then everything else is set up.
const later = () => setTimeout(() => void import("./page"));
// A window that nobody sees paints nothing.
if (document.visibilityState === "hidden") later();
else requestAnimationFrame(later);
