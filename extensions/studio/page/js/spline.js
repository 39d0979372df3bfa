/** Chains of cubic Bezier curves with continuous curvature, for drawing a path by hand. */

export const waypoints_of = (curves) => [curves[0][0], ...curves.map((curve) => curve[3])].map((point) => [...point]);

/**
 * The cubic spline through points, twice continuously differentiable over the chord lengths h, as Bezier curves:
 *   h_k m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_{k-1} m_{k+1} = 3 (h_k d_{k-1} + h_{k-1} d_k),   d = differences over h,
 * with control points p + h m/3 and q - h m'/3. `leave` and `arrive`: the first and the last handle.
 */
export function spline_chain(points, leave, arrive) {
  const n = points.length - 1;
  const h = Array.from({length: n}, (_, k) => Math.max(1e-3, Math.hypot(points[k + 1][0] - points[k][0], points[k + 1][1] - points[k][1])));
  const slopes = [0, 1].map((axis) => {
    const d = h.map((length, k) => (points[k + 1][axis] - points[k][axis]) / length);
    const m = new Array(n + 1).fill(0), upper = new Array(n + 1).fill(0), right = new Array(n + 1).fill(0);
    m[0] = 3 * leave[axis] / h[0];
    m[n] = 3 * arrive[axis] / h[n - 1];
    right[0] = m[0];
    for (let k = 1; k < n; ++k) {
      const diagonal = 2 * (h[k - 1] + h[k]) - h[k] * upper[k - 1];
      upper[k] = h[k - 1] / diagonal;
      right[k] = (3 * (h[k] * d[k - 1] + h[k - 1] * d[k]) - h[k] * right[k - 1]) / diagonal;
    }
    for (let k = n - 1; k > 0; --k) m[k] = right[k] - upper[k] * m[k + 1];
    return m;
  });
  const beside = (k, length, sign) => [0, 1].map((axis) => points[k][axis] + sign * length * slopes[axis][k] / 3);
  return h.map((length, k) => [[...points[k]], beside(k, length, 1), beside(k + 1, length, -1), [...points[k + 1]]]);
}
