// Play, step, speed, and a slider over all ticks with marks where something happened.
import { button } from "./button";
import { eventColour, pageColour } from "./colours";
import type { RunEvent } from "./data";
import { digits } from "./data";
import { type Player, speeds } from "./player";

function speedText(speed: number): string {
  return speed < 1 ? `1/${Math.round(1 / speed)}` : `${speed}x`;
}

export class Timeline {
  readonly element = document.createElement("footer");
  private readonly slider = document.createElement("input");
  private readonly clock = document.createElement("output");
  private readonly note = document.createElement("small");
  private readonly play: HTMLButtonElement;
  private readonly speed = document.createElement("select");

  // frames: the tick with which each frame is first used. goTo: shows an event.
  constructor(private readonly player: Player, private readonly events: RunEvent[], private readonly frames: number[],
    private readonly timeS: (tick: number) => number, private readonly goTo: (tick: number) => void) {
    this.slider.type = "range";
    this.slider.min = "0";
    this.slider.max = String(player.ticks - 1);
    this.slider.ariaLabel = "tick";
    this.slider.addEventListener("input", () => player.go(Number(this.slider.value)));
    this.slider.addEventListener("pointerup", () => this.slider.blur()); // keys are for the time
    this.play = button("Play", "play or stop (space)", () => player.toggle());
    this.clock.ariaLive = "off";
    this.speed.title = "speed: 1x is real time";
    for (const speed of speeds) this.speed.add(new Option(speedText(speed), String(speed)));
    this.speed.addEventListener("change", () => {
      player.setSpeed(Number(this.speed.value));
      this.speed.blur(); // keys are for the time
    });
    const track = document.createElement("div");
    track.className = "track";
    track.append(this.slider, ...this.marks());
    this.element.append(
      this.play, button("|<", "one tick back (,)", () => player.step(-1)), button(">|", "one tick on (.)", () => player.step(1)),
      button("Previous event", "to the event before (E)", () => this.goToEvent(-1)),
      button("Next event", "to the next event (e)", () => this.goToEvent(1)), this.speed, track, this.note, this.clock);
    player.onChange(() => this.show());
    this.show();
  }

  tell(note: string): void {
    this.note.textContent = note;
  }
  // The next or the previous event; beyond the last one the first, and the other way round.
  goToEvent(by: number): void {
    const now = this.player.tick, { events } = this;
    const other = by > 0 ? (events.find((event) => event.tick > now) ?? events[0])
      : (events.findLast((event) => event.tick < now) ?? events.at(-1));
    if (other) this.goTo(other.tick);
  }
  stepFrame(by: number): void {
    const now = this.player.tick;
    const tick = by > 0 ? this.frames.find((first) => first > now) : this.frames.findLast((first) => first < now);
    if (tick !== undefined) this.player.step(tick - now);
  }
  faster(by: number): void {
    const at = speeds.indexOf(this.player.speed) + by;
    if (speeds[at] !== undefined) this.player.setSpeed(speeds[at]);
  }

  // Those of one tick beside each other.
  private marks(): HTMLElement[] {
    return this.events.map((event, i) => {
      const before = this.events.slice(0, i).filter((other) => other.tick === event.tick).length;
      const mark = document.createElement("button");
      mark.type = "button";
      mark.className = "mark";
      mark.tabIndex = -1; // the list of events is for the keyboard
      mark.style.background = pageColour(eventColour(event.kind));
      mark.title = `tick ${event.tick}: ${event.text}`;
      mark.ariaLabel = mark.title;
      mark.style.left = `calc(${(100 * event.tick) / Math.max(this.player.ticks - 1, 1)}% + ${8 * before}px)`;
      mark.addEventListener("click", () => this.goTo(event.tick));
      return mark;
    });
  }
  private show(): void {
    const { tick, playing, speed } = this.player;
    this.slider.value = String(tick);
    this.play.textContent = playing ? "Stop" : "Play";
    this.speed.value = String(speed);
    this.clock.textContent = `${this.timeS(tick).toFixed(3)} s, tick ${digits(tick)}`;
  }
}
