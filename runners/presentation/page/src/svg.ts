// Draws plots as SVG, by the calls of a canvas's context.
import { curveColour } from "./colours";
import type { Ink, Pen, Plot } from "./plots";

const ink: Ink = { line: "#dddddd", quiet: "#555555", isDark: false };
const xmlns = "http://www.w3.org/2000/svg";
const anchors: Record<string, string> = { left: "start", center: "middle", right: "end" };

class SvgPen implements Pen {
  strokeStyle = "#000";
  fillStyle = "#000";
  lineWidth = 1;
  font = "";
  textAlign: CanvasTextAlign = "left";
  textBaseline: CanvasTextBaseline = "middle";
  private path: string[] = [];
  private dash: number[] = [];

  constructor(private readonly into: SVGElement) {}

  beginPath(): void {
    this.path = [];
  }
  moveTo(x: number, y: number): void {
    this.path.push(`M${x.toFixed(2)} ${y.toFixed(2)}`);
  }
  lineTo(x: number, y: number): void {
    this.path.push(`L${x.toFixed(2)} ${y.toFixed(2)}`);
  }
  stroke(): void {
    if (this.path.length === 0) return;
    this.add("path", { d: this.path.join(""), fill: "none", stroke: this.strokeStyle, "stroke-width": this.lineWidth,
      ...(this.dash.length > 0 ? { "stroke-dasharray": this.dash.join() } : {}) });
  }
  setLineDash(dash: Iterable<number>): void {
    this.dash = [...dash];
  }
  fillRect(x: number, y: number, width: number, height: number): void {
    this.add("rect", { x, y, width, height, fill: this.fillStyle });
  }
  fillText(text: string, x: number, y: number): void {
    this.add("text", { x, y: y + 4, fill: this.fillStyle, "text-anchor": anchors[this.textAlign] }).textContent = text;
  }
  add(name: string, attributes: Record<string, string | number>): SVGElement {
    const made = document.createElementNS(xmlns, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
    this.into.append(made);
    return made;
  }
}

// The plots below each other, each with its labels, on a white ground.
export function plotsAsSvg(plots: Plot[], title: string, width = 640, height = 110): string {
  const label = 20, top = 26, whole = top + plots.length * (height + label);
  const svg = document.createElementNS(xmlns, "svg"), page = new SvgPen(svg);
  for (const [key, value] of Object.entries({ width, height: whole, viewBox: `0 0 ${width} ${whole}`, "font-family": "Helvetica, Arial, sans-serif", "font-size": 11 }))
    svg.setAttribute(key, String(value));
  page.add("rect", { width, height: whole, fill: "#ffffff" });
  page.add("text", { x: 6, y: 16, "font-weight": "bold", fill: "#111111" }).textContent = title;
  plots.forEach((plot, i) => {
    const y = top + i * (height + label), words = page.add("text", { x: 6, y: y + 13, fill: "#111111" });
    for (const { text, colour } of plot.labels) {
      const word = document.createElementNS(xmlns, "tspan");
      word.setAttribute("fill", curveColour(colour, false));
      word.textContent = `\u25cf ${text}   `;
      words.append(word);
    }
    const box = page.add("g", { transform: `translate(0 ${y + label})` });
    plot.drawOn(new SvgPen(box), width - 6, height - 6, ink);
  });
  return new XMLSerializer().serializeToString(svg);
}
