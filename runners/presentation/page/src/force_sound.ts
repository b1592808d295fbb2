// The force as a sound, on demand: louder and higher with the force.
export class ForceSound {
  private context: AudioContext | null = null;
  private tone: OscillatorNode | null = null;
  private volume: GainNode | null = null;

  get on(): boolean {
    return this.context !== null;
  }
  toggle(): void {
    if (this.context) {
      void this.context.close();
      this.context = this.tone = this.volume = null;
      return;
    }
    this.context = new AudioContext();
    this.tone = this.context.createOscillator();
    this.volume = this.context.createGain();
    this.tone.type = "triangle";
    this.volume.gain.value = 0;
    this.tone.connect(this.volume).connect(this.context.destination);
    this.tone.start();
  }
  show(forceN: number): void {
    if (!this.context || !this.tone || !this.volume) return;
    const part = Math.min(Math.max(forceN, 0) / 10, 1), now = this.context.currentTime;
    this.volume.gain.setTargetAtTime(0.25 * part, now, 0.02);
    this.tone.frequency.setTargetAtTime(110 + 550 * part, now, 0.02);
  }
}
