// The trajectory as a function of time, in scene coordinates: metres from the data's origin.

const kPathStride = 8;  // t, x, y, z, qx, qy, qz, qw

class Path {
  constructor(numbers) {
    this.count = numbers.length / kPathStride;
    this.numbers = numbers;
    this.times = new Float32Array(this.count);
    for (let i = 0; i < this.count; i++) this.times[i] = numbers[kPathStride * i];
  }

  get begin() { return this.count > 0 ? this.times[0] : 0; }
  get end() { return this.count > 0 ? this.times[this.count - 1] : 0; }

  position(i) {
    const at = kPathStride * i;
    return new THREE.Vector3(this.numbers[at + 1], this.numbers[at + 2], this.numbers[at + 3]);
  }

  rotation(i) {
    const at = kPathStride * i;
    return new THREE.Quaternion(...this.numbers.subarray(at + 4, at + 8));
  }

  /** Where the body is: position and rotation, between two poses too. */
  at(t) {
    const i = lastNotAbove(this.times, t), j = Math.min(i + 1, this.count - 1);
    const span = this.times[j] - this.times[i];
    const share = span > 0 ? Math.min(1, Math.max(0, (t - this.times[i]) / span)) : 0;
    return {
      position: this.position(i).lerp(this.position(j), share),
      rotation: this.rotation(i).slerp(this.rotation(j), share)};
  }

  box() {
    const box = new THREE.Box3();
    for (let i = 0; i < this.count; i++) box.expandByPoint(this.position(i));
    return box;
  }

  /** Ends of all pieces in a row, and for each end whether `marked(t)` holds at its piece's end. */
  pieces(marked) {
    const ends = [], marks = [];
    for (let i = 1; i < this.count; i++) {
      ends.push(...this.position(i - 1).toArray(), ...this.position(i).toArray());
      marks.push(marked(this.times[i]));
    }
    return {ends, marks};
  }
}
