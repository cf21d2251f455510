// Shows a coded picture under each photograph that carries one, until the photograph has loaded:
//
//     <span class="photo"><img src="photo.jpg" width="768" height="512" data-imgm="mklNEv8F..."></span>
//
// Needs imgm.min.js, and the first rules of placeholders.css.
import { drawTo } from "./imgm.min.js";

export function showPlaceholder(img) {
  const canvas = document.createElement("canvas");
  try {
    drawTo(canvas, Uint8Array.from(atob(img.dataset.imgm), (c) => c.charCodeAt(0)));
  } catch (error) {
    console.warn(img.src, error.message); // the photograph comes without a placeholder
    return;
  }
  canvas.ariaHidden = "true";
  img.before(canvas);
  const show = () => img.classList.add("loaded");
  if (img.complete && img.naturalWidth > 0) show();
  else img.addEventListener("load", show, { once: true });
}

for (const img of document.querySelectorAll("img[data-imgm]")) showPlaceholder(img);

// The button of the demonstration: takes the photographs away for two seconds.
document.querySelector("#again")?.addEventListener("click", () => {
  for (const img of document.querySelectorAll("img[data-imgm].loaded")) {
    const { src } = img;
    img.classList.remove("loaded");
    img.removeAttribute("src");
    img.addEventListener("load", () => img.classList.add("loaded"), { once: true });
    setTimeout(() => (img.src = src), 2000);
  }
});
