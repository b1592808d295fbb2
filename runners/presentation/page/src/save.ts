// Pictures of the page as files: the 3-D view as PNG, the plots as SVG.

function download(blob: Blob | null, name: string): void {
  if (!blob) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// "lift.h5", 534, "png": "lift-tick-534.png".
export function pictureName(file: string, tick: number, ending: string): string {
  return `${file.replace(/\.[^.]*$/, "").replace(/[^\w.-]+/g, "-") || "run"}-tick-${tick}.${ending}`;
}

export function saveSvg(text: string, name: string): void {
  download(new Blob([text], { type: "image/svg+xml" }), name);
}

// bar: the scale bar, which lies over the canvas.
export function savePng(canvas: HTMLCanvasElement, bar: HTMLElement | null, name: string): void {
  const copy = document.createElement("canvas"), pen = copy.getContext("2d");
  if (!pen) return;
  copy.width = canvas.width;
  copy.height = canvas.height;
  pen.fillStyle = getComputedStyle(canvas.parentElement ?? canvas).backgroundColor;
  pen.fillRect(0, 0, copy.width, copy.height);
  pen.drawImage(canvas, 0, 0);
  if (bar) drawBar(pen, canvas, bar);
  copy.toBlob((blob) => download(blob, name), "image/png");
}

function drawBar(pen: CanvasRenderingContext2D, canvas: HTMLCanvasElement, bar: HTMLElement): void {
  const ratio = canvas.width / Math.max(canvas.clientWidth, 1), around = canvas.getBoundingClientRect(), at = bar.getBoundingClientRect();
  pen.scale(ratio, ratio);
  pen.fillStyle = "#eee";
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.fillRect(at.left - around.left, at.bottom - around.top - 2, at.width, 2);
  pen.fillText(bar.textContent ?? "", (at.left + at.right) / 2 - around.left, at.bottom - around.top - 7);
}
