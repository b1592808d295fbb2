// How much of the points is drawn where graphics are slow: half as much after pictures that took long, twice as much after
// some that did not.
const slowMs = 150, quickMs = 40, leastShare = 1 / 32;

export class Pace {
  share = 1;
  private before = 0;
  private slow = 0;
  private quick = 0;

  // At every picture; whether the share has changed.
  picture(nowMs: number): boolean {
    const took = nowMs - this.before;
    this.before = nowMs;
    this.slow = took > slowMs && took < 5000 ? this.slow + 1 : 0;
    this.quick = took < quickMs ? this.quick + 1 : 0;
    if (this.slow >= 2 && this.share > leastShare) return this.set(this.share / 2);
    if (this.quick >= 60 && this.share < 1) return this.set(this.share * 2);
    return false;
  }
  private set(share: number): boolean {
    this.share = share;
    this.slow = this.quick = 0;
    return true;
  }
}

// Says in the picture that not all points are drawn.
export class PaceNote {
  private readonly element = document.createElement("small");

  constructor(picture: HTMLElement) {
    this.element.className = "pace";
    picture.append(this.element);
  }
  // but: which points are always drawn.
  show(share: number, but = ""): void {
    this.element.textContent = share < 1 ? `slow graphics: 1 of ${1 / share} points is drawn${but}` : "";
  }
}
