// A camera that turns about a point, z upwards. Matrices are columns, as WebGL has them.
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, b, s) => [a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s];

const fieldOfView = 0.5;  // radian, upright

class Camera {
  constructor(box) {
    this.home = box;
    this.look(-54, 16);
    this.fit();
  }

  fit(aspect = 1.5) {
    const { min, max } = this.home;
    this.target = [0, 1, 2].map((i) => 0.5 * (min[i] + max[i]));
    this.radius = 0.5 * Math.hypot(...subtract(max, min)) || 1;
    this.distance = this.radius / Math.sin(fieldOfView / 2) * Math.max(0.8, 1.05 / Math.min(Math.max(aspect, 0.4), 1.3));
  }

  // Unit vectors to the right, upwards and towards the eye.
  axes() {
    const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    const towards = [ce * ca, ce * sa, se], right = [-sa, ca, 0];
    return { right, up: cross(towards, right), towards };
  }

  look(azimuth, elevation) {
    this.azimuth = azimuth * Math.PI / 180;
    this.elevation = elevation * Math.PI / 180;
  }

  // Angles, distance by that of home, and what is looked at: to be written down, and taken again.
  said() {
    return [this.azimuth * 180 / Math.PI, this.elevation * 180 / Math.PI, this.distance / this.radius, ...this.target]
      .map((value) => Number(value.toPrecision(4)));
  }
  hear([azimuth, elevation, distance, ...target]) {
    this.look(azimuth, elevation);
    this.target = target;
    this.distance = distance * this.radius;
  }

  turn(dx, dy) {
    this.azimuth -= dx * 0.008;
    this.elevation = Math.max(-1.5707, Math.min(1.5707, this.elevation + dy * 0.008));
  }

  move(dx, dy, height) {
    const { right, up } = this.axes();
    const scale = 2 * this.distance * Math.tan(fieldOfView / 2) / height;
    this.target = along(along(this.target, right, -dx * scale), up, dy * scale);
  }

  zoom(factor) {
    this.distance = Math.max(this.radius * 0.02, Math.min(this.radius * 60, this.distance * factor));
  }

  view() {
    const { right, up, towards } = this.axes();
    const eye = along(this.target, towards, this.distance);
    const [x, y, z] = [right, up, towards];
    return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
      -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
  }

  // \param reach radius about the target in which everything lies
  projection(aspect, reach) {
    const near = Math.max(this.distance * 0.02, this.distance - reach), far = this.distance + reach;
    const f = 1 / Math.tan(fieldOfView / 2);
    return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (near + far) / (near - far), -1, 0, 0,
      2 * near * far / (near - far), 0]);
  }
}
