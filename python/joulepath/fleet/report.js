// Playback: the slider moves the line in each chart and the robots on the map.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const slider = document.getElementById("time"), button = document.getElementById("play"), now = document.getElementById("now");
  const lines = document.querySelectorAll(".line"), robots = document.querySelectorAll(".robot");
  const kPlay_ms = 40000;
  let began = null;

  const along = (track, share) => {
    let k = 1;
    while (k < track.length - 1 && track[k][0] < share) ++k;
    const [s0, x0, y0] = track[k - 1], [s1, x1, y1] = track[k];
    const part = s1 > s0 ? Math.min(1, Math.max(0, (share - s0) / (s1 - s0))) : 1;
    return [x0 + part * (x1 - x0), y0 + part * (y1 - y0)];
  };
  const place = ({start, moves}, time) => {
    const begun = moves.filter(([from]) => from <= time);
    if (!begun.length) return start;
    const [from, to, track] = begun[begun.length - 1];
    return along(data.tracks[track], to > from ? Math.min(1, (time - from) / (to - from)) : 1);
  };
  const show = () => {
    const time = Number(slider.value), left = `${100 * time / data.end_s}%`;
    now.textContent = `${time.toFixed(0)} of ${data.end_s} s`;
    for (const line of lines) line.style.left = left;
    robots.forEach((dot, n) => { [dot.style.left, dot.style.top] = place(data.robots[n], time).map((v) => `${v}%`); dot.classList.toggle("left", parseFloat(dot.style.left) > 75); });
  };
  const stop = () => { began = null; button.textContent = "Play"; button.setAttribute("aria-pressed", "false"); };
  const step = (clock) => {
    if (began === null) return;
    slider.value = Math.min(data.end_s, (clock - began) / kPlay_ms * data.end_s);
    show();
    if (Number(slider.value) >= data.end_s) stop(); else requestAnimationFrame(step);
  };
  button.addEventListener("click", () => {
    if (began !== null) return stop();
    if (Number(slider.value) >= data.end_s) slider.value = 0;
    button.textContent = "Pause"; button.setAttribute("aria-pressed", "true");
    requestAnimationFrame((clock) => { began = clock - Number(slider.value) / data.end_s * kPlay_ms; step(clock); });
  });
  slider.addEventListener("input", () => { stop(); show(); });
  show();
})();
