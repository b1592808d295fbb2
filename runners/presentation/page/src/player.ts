// The time that is shown: a tick of the runs, which plays, stops and steps. Who shows something listens.

export const speeds = [1 / 50, 1 / 20, 1 / 10, 1 / 4, 1 / 2, 1, 2, 4];

export class Player {
  tick = 0;
  playing = false;
  speed = 1 / 4;
  private exact = 0; // ticks, with fractions
  private before = 0;
  private readonly listeners: (() => void)[] = [];

  constructor(readonly ticks: number, private readonly rateHz: number) {}

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  go(tick: number): void {
    this.exact = Math.min(Math.max(Math.round(tick), 0), this.ticks - 1);
    this.set(this.exact);
  }
  step(by: number): void {
    this.playing = false;
    this.go(this.tick + by);
    this.tell();
  }
  toggle(): void {
    this.playing = !this.playing;
    if (this.playing && this.tick >= this.ticks - 1) this.go(0);
    this.before = performance.now();
    this.tell();
    if (this.playing) requestAnimationFrame(this.advance);
  }
  stop(): void {
    this.playing = false;
  }
  setSpeed(speed: number): void {
    this.speed = speed;
    this.tell();
  }

  private readonly advance = (now: number): void => {
    if (!this.playing) return;
    this.exact += (Math.max(now - this.before, 0) / 1000) * this.speed * this.rateHz;
    this.before = now;
    if (this.exact >= this.ticks - 1) {
      this.exact = this.ticks - 1;
      this.playing = false;
    }
    this.set(Math.floor(this.exact));
    if (this.playing) requestAnimationFrame(this.advance);
    else this.tell();
  };
  private set(tick: number): void {
    if (tick === this.tick) return;
    this.tick = tick;
    this.tell();
  }
  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
