// Turns the voxels of a report: points drawn with WebGL, decoded from the page itself.
'use strict';
(() => {
  const VERTEX = `
    attribute vec3 place;
    attribute vec3 color;
    uniform mat3 turn;
    uniform vec2 scale;
    uniform float size;
    uniform float radius;
    varying vec3 shade;
    void main() {
      vec3 at = turn * place;
      gl_Position = vec4(at.xy * scale, at.z / radius * 0.5, 1.0);
      gl_PointSize = size;
      shade = color * (0.75 - 0.3 * at.z / radius);
    }`;
  const FRAGMENT = `
    precision mediump float;
    varying vec3 shade;
    uniform float round;
    void main() {
      vec2 away = 2.0 * gl_PointCoord - 1.0;
      gl_FragColor = vec4(shade * (1.0 - round * 0.35 * dot(away, away)), 1.0);
    }`;
  const KINDS = ['common', 'onlyA', 'onlyB', 'value'];

  const numbers = (text) => text.trim().split(/\s+/).map(Number);
  const rgb = (css) => [1, 3, 5].map((i) => parseInt(css.slice(i, i + 2), 16) / 255);

  // Points of one kind after the other: { places, colors, ranges: {kind: [first, count]} }.
  function decode(viewer) {
    const text = atob(viewer.querySelector('script').textContent);
    const count = Number(viewer.dataset.count);
    const box = numbers(viewer.dataset.box);
    const axes = numbers(viewer.dataset.axes);
    const palette = viewer.dataset.colors.trim().split(' ').map(rgb);
    const middle = [0, 1, 2].map((i) => (box[i] + box[i + 3]) / 2);
    let next = 0;
    const number = () => {
      let value = 0;
      for (let shift = 0;; shift += 7) {
        const byte = text.charCodeAt(next++);
        value += (byte & 127) * 2 ** shift;
        if (byte < 128) break;
      }
      return value % 2 ? -(value + 1) / 2 : value / 2;
    };
    const points = [[], [], [], []];
    const at = box.slice(0, 3);
    for (let i = 0; i < count; ++i) {
      for (let k = 0; k < 3; ++k) at[k] += number();
      const byte = text.charCodeAt(next++);
      const kind = byte >> 6;
      const part = (byte & 63) / 63;
      const color = kind < 3 ? palette[kind] :
                               palette[3].map((low, k) => (1 - part) * low + part * palette[4][k]);
      const index = at.map((value, k) => value - middle[k]);
      const place = [0, 1, 2].map(
          (k) => index[0] * axes[k] + index[1] * axes[3 + k] + index[2] * axes[6 + k]);
      points[kind].push(...place, ...color);
    }
    const ranges = {};
    let first = 0;
    points.forEach((list, kind) => {
      ranges[KINDS[kind]] = [first, list.length / 6];
      first += list.length / 6;
    });
    const data = new Float32Array(first * 6);
    points.reduce((offset, list) => (data.set(list, offset), offset + list.length), 0);
    const side = Math.hypot(axes[0], axes[1], axes[2]);
    let radius = 0;
    for (let i = 0; i < data.length; i += 6)
      radius = Math.max(radius, Math.hypot(data[i], data[i + 1], data[i + 2]));
    return {data, ranges, radius: radius + side, side};
  }

  function program(gl) {
    const linked = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(linked, shader);
    }
    gl.linkProgram(linked);
    return gl.getProgramParameter(linked, gl.LINK_STATUS) ? linked : null;
  }

  // Right, up and out of the picture, as rows; world z is up.
  function turnOf(azimuth, elevation) {
    const [s, c] = [Math.sin(azimuth), Math.cos(azimuth)];
    const [se, ce] = [Math.sin(elevation), Math.cos(elevation)];
    const rows = [[c, s, 0], [-s * se, c * se, ce], [-s * ce, c * ce, -se]];
    return [0, 1, 2].flatMap((column) => rows.map((row) => row[column]));
  }

  function start(viewer) {
    const canvas = viewer.querySelector('canvas');
    const gl = canvas.getContext('webgl', {preserveDrawingBuffer: true});
    const used = gl && program(gl);
    if (!used) return;
    const {data, ranges, radius, side} = decode(viewer);
    gl.useProgram(used);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    ['place', 'color'].forEach((name, i) => {
      const attribute = gl.getAttribLocation(used, name);
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 24, 12 * i);
    });
    gl.enable(gl.DEPTH_TEST);
    const uniform = (name) => gl.getUniformLocation(used, name);
    const [azimuth, elevation] =
        numbers(viewer.dataset.view).map((degrees) => degrees * Math.PI / 180);
    const first = {azimuth, elevation, zoom: 1};
    const view = {...first};
    const largest = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1];

    let asked = false;
    function draw() {
      asked = false;
      const ratio = window.devicePixelRatio || 1;
      const [width, height] =
          [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
      if (canvas.width !== width || canvas.height !== height)
        [canvas.width, canvas.height] = [width, height];
      gl.viewport(0, 0, width, height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const perUnit = view.zoom * Math.min(width, height) / (2 * radius);
      const pixels = 1.2 * perUnit * side;
      gl.uniformMatrix3fv(uniform('turn'), false, turnOf(view.azimuth, view.elevation));
      gl.uniform2f(uniform('scale'), 2 * perUnit / width, 2 * perUnit / height);
      gl.uniform1f(uniform('radius'), radius);
      gl.uniform1f(uniform('round'), pixels > 5 ? 1 : 0);
      for (const kind of KINDS) {
        const box = viewer.querySelector(`input[name=${kind}]`);
        if (box && !box.checked) continue;
        const least = kind === 'common' && ranges.common[1] < data.length / 6 ? 1 : 2.5;
        gl.uniform1f(uniform('size'), Math.min(largest, Math.max(least * ratio, pixels)));
        gl.drawArrays(gl.POINTS, ...ranges[kind]);
      }
    }
    const redraw = () => {
      if (!asked) requestAnimationFrame(draw);
      asked = true;
    };
    const turn = (right, up) => {
      view.azimuth += right;
      view.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, view.elevation + up));
      redraw();
    };
    const zoom = (factor) => {
      view.zoom = Math.max(0.3, Math.min(200, view.zoom * factor));
      redraw();
    };
    const STEP = Math.PI / 12;
    const actions = {
      left: () => turn(STEP, 0),
      right: () => turn(-STEP, 0),
      up: () => turn(0, -STEP),
      down: () => turn(0, STEP),
      nearer: () => zoom(1.25),
      farther: () => zoom(0.8),
      start: () => {
        Object.assign(view, first);
        redraw();
      },
    };
    const keys = {
      ArrowLeft: 'left',
      ArrowRight: 'right',
      ArrowUp: 'up',
      ArrowDown: 'down',
      '+': 'nearer',
      '=': 'nearer',
      '-': 'farther',
      Home: 'start'
    };
    for (const button of viewer.querySelectorAll('button'))
      button.addEventListener('click', actions[button.name]);
    for (const box of viewer.querySelectorAll('input')) box.addEventListener('change', redraw);
    canvas.addEventListener('keydown', (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
      actions[keys[event.key]]();
      event.preventDefault();
    });
    canvas.addEventListener('wheel', (event) => {
      zoom(Math.exp(-event.deltaY / 500));
      event.preventDefault();
    }, {passive: false});

    const held = new Map();  // pointers by id
    const spread = () => {
      const [a, b] = [...held.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      held.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    canvas.addEventListener('pointermove', (event) => {
      const before = held.get(event.pointerId);
      if (!before) return;
      const apart = held.size === 2 ? spread() : 0;
      const now = {x: event.clientX, y: event.clientY};
      held.set(event.pointerId, now);
      if (held.size === 1)
        turn(-(now.x - before.x) * 0.01, (now.y - before.y) * 0.01);
      else if (held.size === 2 && apart > 0)
        zoom(spread() / apart);
    });
    for (const end of ['pointerup', 'pointercancel'])
      canvas.addEventListener(end, (event) => held.delete(event.pointerId));
    canvas.addEventListener('webglcontextlost', () => viewer.classList.remove('ready'));
    viewer.classList.add('ready');
    new ResizeObserver(redraw).observe(canvas);
    redraw();
  }

  for (const viewer of document.querySelectorAll('.viewer')) start(viewer);
})();
