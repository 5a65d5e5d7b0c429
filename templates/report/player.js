// The sheets and the machine in space.

const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];
const COVERED = 0xd6336c, CLEAR = 0x2f9e44; // the rod along which a sensor sees, with a sheet there and without
const KINDS = {
  roller: { color: 0xaab4bf }, sector: { color: 0x56616b }, mark: { color: 0xd55e00 }, arm: { color: 0xa98f63 }, mesh: { color: 0x7d93a8 },
  plane: { color: 0xc8ccd2, opacity: 0.35 }, guide: { color: 0x7d93a8, opacity: 0.45 },
  sensor: { color: CLEAR },
  drive: { color: 0x0072b2 }, press: { color: 0x009e73 }, motion: { color: 0xcc79a7 }, load: { color: 0xe69f00 },
};
const GHOST = { color: 0x808890, opacity: 0.4 };
const ARROWS = ["drive", "press", "motion", "load"];
// Lit once a corner and not once a pixel, which is what costs without a graphics card.
const LAMP = [-0.3, -0.5, 0.81]; // from above, and a little from the left and the front
const VERTEX = `
  uniform vec3 tone; varying vec3 shade;
  void main() {
    #ifdef BOXES
      shade = color;
    #else
      shade = tone * (0.8 + 0.25 * dot(mat3(modelMatrix) * normal, vec3(${LAMP})));
    #endif
    gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
  }`;
const FRAGMENT = `
  uniform float opacity; varying vec3 shade;
  void main() { gl_FragColor = vec4(shade, opacity); }`;
// where the camera is, seen from what it looks at; z is up, from above y
const VIEWS = { xz: [0, -1, 0], yz: [-1, 0, 0], xy: [0, -1e-5, 1], iso: [-0.55, -0.75, 0.5] };
const PRINTED_AT = 2; // pixels of the printed picture for one of the page
const FAR = 1000, TURNED = 1e-4; // of the eye [mm]; of its direction: less is round-off
const SLOW = 40, COARSEST = 0.4; // ms a picture; part of the finest
const THIN = 2.5; // pixels that a sheet is thick at least, so that it is seen from the side
// corners of a box's faces, four each, counterclockwise: bits 0, 1 and 2 tell the sides along x, y and z
const FACES = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
const JOINT = 0.96; // boxes are drawn this much smaller along the sheet, so that joints are seen

const RAMP = `linear-gradient(to right, ${VIRIDIS.join(", ")})`;

// Whether the picture is drawn without a graphics card, where every pixel costs.
function soft() {
  const probe = document.createElement("canvas").getContext("webgl2");
  const name = probe?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL;
  const found = name ? /swiftshader|llvmpipe|software|basic render/i.test(probe.getParameter(name)) : false;
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return found;
}

async function library() {
  const text = (name) => document.querySelector(`script[data-library="${name}"]`).textContent;
  const url = (code) => URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  const core = url(text("three.core.min.js"));
  const three = url(text("three.module.min.js").replaceAll("./three.core.min.js", core));
  const { OrbitControls } = await import(url(text("OrbitControls.js").replace("from 'three'", `from '${three}'`)));
  return [await import(three), OrbitControls];
}

async function player(canvas, changed) {
  const [THREE, OrbitControls] = await library();
  // opaque, so that the browser need not blend each picture with the page
  const context = canvas.getContext("webgl2", { alpha: false, antialias: !soft(), powerPreference: "default" });
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  const finest = Math.min(window.devicePixelRatio, 2);
  let fineness = finest;
  const scene = new THREE.Scene();
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const ground = () => { scene.background = new THREE.Color(getComputedStyle(canvas).backgroundColor); };
  ground();
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1e5, 1e5);
  camera.up.set(0, 0, 1);
  camera.position.set(0, -FAR, 0);
  // orbit, move, zoom, by mouse and touch
  const controls = new OrbitControls(camera, canvas);
  controls.zoomToCursor = true;
  const { target } = controls;
  const away = new THREE.Vector3(0, -1, 0), before = new THREE.Vector3(0, -1, 0); // from what is looked at to the eye
  controls.addEventListener("change", () => {
    away.subVectors(camera.position, target).normalize();
    if (away.distanceTo(before) > TURNED) changed();
    before.copy(away);
    refresh();
  });
  let size = 100, follow = false, machine = true, arrows = true, seen = null, ghost = null, time = 0;

  const part = (colour, i) => parseInt(colour.slice(1 + 2 * i, 3 + 2 * i), 16) / 255;
  const ramp = new Float32Array(256 * 3);
  for (let k = 0; k < 256; k += 1) {
    const at = (k / 255) * (VIRIDIS.length - 1), first = Math.min(Math.floor(at), VIRIDIS.length - 2);
    for (let i = 0; i < 3; i += 1) {
      ramp[3 * k + i] = part(VIRIDIS[first], i) + (at - first) * (part(VIRIDIS[first + 1], i) - part(VIRIDIS[first], i));
    }
  }

  const position = new THREE.Vector3(), axis = new THREE.Vector3(), one = new THREE.Quaternion(), two = new THREE.Quaternion();
  const sides = new Float64Array(9), light = new Float64Array(3), corners = new Float64Array(24);

  function paint({ color = 0, opacity = 1 }, more = {}) {
    const tone = new THREE.Vector3((color >> 16) / 255, ((color >> 8) & 255) / 255, (color & 255) / 255);
    const uniforms = { tone: { value: tone }, opacity: { value: opacity } };
    // what lies behind or in a translucent part is still seen
    return new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, transparent: opacity < 1, depthWrite: opacity === 1, ...more });
  }

  // All boxes as one shape: where there is no graphics card, each instance of one would cost as much as a shape.
  function blocks(count) {
    const index = new Uint32Array(36 * count);
    for (let face = 0; face < 6 * count; face += 1) {
      for (let k = 0; k < 6; k += 1) index[6 * face + k] = 4 * face + [0, 1, 2, 0, 2, 3][k];
    }
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(72 * count), 3).setUsage(THREE.DynamicDrawUsage));
    shape.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(72 * count), 3, true).setUsage(THREE.DynamicDrawUsage));
    shape.setIndex(new THREE.BufferAttribute(index, 1));
    const made = new THREE.Mesh(shape, paint({}, { vertexColors: true, defines: { BOXES: "" } }));
    made.frustumCulled = false;
    return made;
  }

  // A run, ready to be drawn.
  function take(animation) {
    const half = unpack(animation.half, Float32Array);
    const run = {
      animation, half, place: unpack(animation.place, Uint16Array), turn: unpack(animation.turn, Int16Array),
      colours: animation.colours.map((c) => ({ ...c, values: unpack(c.values, Uint8Array) })).map((c) => ({ ...c, fixed: c.values.length === animation.boxes })),
      group: new THREE.Group(), parts: [], last: new THREE.Vector3(), known: false,
    };
    // from when to when each box is there
    run.came = new Float64Array(animation.boxes).fill(-Infinity);
    run.left = new Float64Array(animation.boxes).fill(Infinity);
    for (const [first, many, came, gone] of animation.stays ?? []) {
      run.came.fill(came ?? Infinity, first, first + many);
      run.left.fill(gone ?? Infinity, first, first + many);
    }
    run.boxes = blocks(animation.boxes);
    run.group.add(run.boxes);
    for (const mesh of animation.meshes) {
      const shape = new THREE.BufferGeometry();
      shape.setAttribute("position", new THREE.BufferAttribute(unpack(mesh.points, Float32Array), 3));
      shape.setIndex(new THREE.BufferAttribute(unpack(mesh.triangles, Uint16Array), 1));
      const flat = shape.toNonIndexed();
      flat.computeVertexNormals();
      // an arrow is not hidden by what it is about, nor a beam by the sheet that covers it
      const over = ARROWS.includes(mesh.kind) || mesh.kind === "sensor";
      const drawn = new THREE.Mesh(flat, paint(KINDS[mesh.kind], over ? { depthTest: false, transparent: true } : {}));
      drawn.renderOrder = Number(over);
      drawn.position.fromArray(mesh.place);
      drawn.quaternion.set(mesh.turn[1], mesh.turn[2], mesh.turn[3], mesh.turn[0]);
      run.group.add(drawn);
      run.parts.push({ drawn, row: mesh.row, kind: mesh.kind, mesh });
    }
    return run;
  }

  // Position and rotation of a body between the states k and k + 1.
  function pose(run, row, k, part) {
    const { animation, place, turn } = run;
    const next = Math.min(k + 1, animation.time.length - 1);
    const a = k * animation.bodies + row, b = next * animation.bodies + row;
    for (let i = 0; i < 3; i += 1) {
      position.setComponent(i, animation.low[i] + animation.step[i] * (place[3 * a + i] * (1 - part) + place[3 * b + i] * part));
    }
    one.set(turn[4 * a + 1], turn[4 * a + 2], turn[4 * a + 3], turn[4 * a]).normalize();
    two.set(turn[4 * b + 1], turn[4 * b + 2], turn[4 * b + 3], turn[4 * b]).normalize();
    one.slerp(two, part);
  }

  function pointer(animation, at) {
    let low = 0, high = animation.time.length - 1;
    while (high - low > 1) { const middle = (low + high) >> 1; if (animation.time[middle] <= at) low = middle; else high = middle; }
    const span = animation.time[high] - animation.time[low];
    return span > 0 ? [low, Math.min(Math.max((at - animation.time[low]) / span, 0), 1)] : [low, 0];
  }

  const middle = new THREE.Vector3(), moved = new THREE.Vector3();
  function refreshPoses() {
    if (!seen) return;
    if (ghost) move(ghost);
    move(seen);
    for (const { drawn, row, kind } of seen.parts) drawn.visible = ARROWS.includes(kind) ? arrows : machine;
    if (follow && seen.known) { target.add(moved.subVectors(middle, seen.last)); camera.position.add(moved); }
    seen.last.copy(middle);
    seen.known = true;
  }

  // Moves the boxes and parts of a run to where they are at the time.
  function move(run) {
    const { animation, boxes, half } = run;
    const [k, part] = pointer(animation, time);
    const colour = run.colours[run.colour];
    const near = part < 0.5 ? k : Math.min(k + 1, animation.time.length - 1);
    const points = boxes.geometry.attributes.position, tints = boxes.geometry.attributes.color;
    middle.set(0, 0, 0);
    let there = 0;
    for (let row = 0; row < animation.boxes; row += 1) {
      if (time < run.came[row] || time >= run.left[row]) { // a box without a size is not seen
        points.array.fill(0, 72 * row, 72 * row + 72);
        continue;
      }
      pose(run, row, k, part);
      middle.add(position);
      there += 1;
      for (let k = 0; k < 3; k += 1) {
        axis.set(Number(k === 0), Number(k === 1), Number(k === 2)).applyQuaternion(one);
        // both faces are lit alike, so that colours mean the same on both
        light[k] = 255 * (0.72 + 0.28 * Math.abs(axis.x * LAMP[0] + axis.y * LAMP[1] + axis.z * LAMP[2]));
        axis.multiplyScalar(k < 2 ? half[3 * row + k] * JOINT : Math.max(half[3 * row + 2], thin));
        sides[3 * k] = axis.x; sides[3 * k + 1] = axis.y; sides[3 * k + 2] = axis.z;
      }
      for (let c = 0; c < 8; c += 1) {
        const x = c & 1 ? 1 : -1, y = c & 2 ? 1 : -1, z = c & 4 ? 1 : -1;
        for (let i = 0; i < 3; i += 1) corners[3 * c + i] = position.getComponent(i) + x * sides[i] + y * sides[3 + i] + z * sides[6 + i];
      }
      const value = 3 * colour.values[(colour.fixed ? 0 : near * animation.boxes) + row];
      for (let face = 0, at = 72 * row; face < 6; face += 1) {
        for (let k = 0; k < 4; k += 1, at += 3) {
          const corner = 3 * FACES[face][k];
          for (let i = 0; i < 3; i += 1) {
            points.array[at + i] = corners[corner + i];
            tints.array[at + i] = light[face >> 1] * ramp[value + i];
          }
        }
      }
    }
    if (there) middle.multiplyScalar(1 / there); else middle.copy(run.last);
    points.needsUpdate = true;
    tints.needsUpdate = true;
    for (const { drawn, row, mesh } of run.parts) {
      if (mesh.spans && run !== ghost) {
        const tone = mesh.spans.some(([begin, end]) => time >= begin && time <= end) ? COVERED : CLEAR;
        drawn.material.uniforms.tone.value.set((tone >> 16) / 255, ((tone >> 8) & 255) / 255, (tone & 255) / 255);
      }
      if (row < 0) continue;
      pose(run, row, k, part);
      drawn.position.copy(position);
      drawn.quaternion.copy(one);
    }
  }

  // Runs that are not seen any more. What their graphics take is given back once another is drawn, which has the
  // same programs: those without a user would be compiled again.
  const left = [];
  function drop(run) {
    for (const { geometry, material } of [run.boxes, ...run.parts.map((part) => part.drawn)]) { geometry.dispose(); material.dispose(); }
  }

  // A run as a ghost behind the one that is seen: its sheets, and the parts of its machine that stand elsewhere.
  function faint(animation) {
    const run = take(animation), as = ({ points, place, turn }) => `${place} ${turn} ${points}`;
    const there = new Set(seen.parts.map(({ mesh }) => as(mesh)));
    run.boxes.material.dispose();
    const behind = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4 };
    run.boxes.material = paint(GHOST, behind);
    run.colour = 0;
    for (const { drawn, mesh } of run.parts) {
      drawn.material.dispose();
      drawn.material = paint(GHOST, behind);
      drawn.visible = !there.has(as(mesh));
    }
    return run;
  }

  let wide = 0, high = 0, drawn = 0, thin = 0; // thin: half of what a sheet is thick at least [mm]
  function draw() {
    if (!wide || !high) return;
    if (drawn !== fineness) { // the renderer makes its buffers anew each time that it is animation
      renderer.setPixelRatio(drawn = fineness);
      renderer.setSize(wide, high, false);
    }
    const ratio = wide / high;
    camera.left = -size * ratio; camera.right = size * ratio; camera.top = size; camera.bottom = -size;
    const before = thin;
    thin = THIN * size / (camera.zoom * high * Math.max(fineness, 1));
    if (thin !== before) refreshPoses();
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
    while (left.length) drop(left.pop());
    shown.drew?.();
  }

  let waiting = false;
  function refresh() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  }

  // How large a part of the scene is, seen as the camera sees it; all but the planes, whose size says nothing.
  function fit(sheets) {
    if (!seen) return;
    const box = new THREE.Box3();
    const { animation } = seen;
    for (let k = 0; k < animation.time.length; k += sheets ? animation.time.length : Math.max(1, Math.floor(animation.time.length / 8))) {
      const at = sheets ? pointer(animation, time)[0] : k;
      for (let row = 0; row < animation.boxes; row += 1) { pose(seen, row, at, 0); box.expandByPoint(position); }
    }
    if (!sheets && machine) for (const { drawn, kind } of seen.parts) if (kind !== "plane") box.expandByObject(drawn);
    box.expandByScalar(0.02 * box.getSize(moved).length());
    box.getCenter(target);
    camera.zoom = 1;
    camera.position.copy(target).addScaledVector(away, FAR);
    controls.update();
    camera.updateMatrixWorld();
    let across = 0, up = 0;
    for (let k = 0; k < 8; k += 1) {
      moved.set(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z);
      moved.applyMatrix4(camera.matrixWorldInverse);
      across = Math.max(across, Math.abs(moved.x)); up = Math.max(up, Math.abs(moved.y));
    }
    size = 1.15 * Math.max(up, across * high / Math.max(wide, 1), 1e-3);
    camera.left = -size * wide / high; camera.right = -camera.left; camera.top = size; camera.bottom = -size;
  }

  const shown = {
    THREE,
    runs: [],
    add(animation) { this.runs.push(take(animation)); },
    // Another run in the place of one, seen as that was.
    replace(index, animation) {
      const before = this.runs[index];
      this.runs[index] = take(animation);
      if (!seen || seen === before) this.choose(index);
      if (before) left.push(before);
    },
    // A run over the one that is seen, as a ghost; null: none.
    ghost(animation) {
      if (ghost) { scene.remove(ghost.group); left.push(ghost); }
      ghost = animation && faint(animation);
      if (ghost) scene.add(ghost.group);
      refreshPoses(); refresh();
    },
    choose(index) {
      if (seen) scene.remove(seen.group);
      const colour = seen ? seen.colour : 0;
      seen = this.runs[index];
      seen.colour = Math.min(colour, seen.colours.length - 1);
      seen.known = false;
      scene.add(seen.group);
      refreshPoses(); refresh();
    },
    colour(index) { seen.colour = index; refreshPoses(); refresh(); },
    view(name) {
      before.copy(away.set(...VIEWS[name]).normalize());
      fit(false); refresh();
    },
    near() { fit(true); refresh(); },
    follow(value) { follow = value; },
    machine(value) { machine = value; refreshPoses(); refresh(); },
    arrows(value) { arrows = value; refreshPoses(); refresh(); },
    // Where a point [mm] is on the canvas [px].
    project(point) {
      moved.fromArray(point).project(camera);
      return [(moved.x + 1) * wide / 2, (1 - moved.y) * high / 2];
    },
    // A direction as it is seen: to the right and upward, and toward the eye.
    seenAlong(way) { moved.fromArray(way).transformDirection(camera.matrixWorldInverse); return [moved.x, moved.y, moved.z]; },
    pixelsPerMm() { return camera.zoom * high / (2 * size); },
    size() { return [wide, high]; },
    // The value that colours a box now, in words.
    valueAt(box) {
      const { least, most, unit, values, fixed } = seen.colours[seen.colour];
      const [k, part] = pointer(seen.animation, time);
      const near = fixed || part < 0.5 ? k : Math.min(k + 1, seen.animation.time.length - 1);
      return `${number(least + (most - least) * values[(fixed ? 0 : near * seen.animation.boxes) + box] / 255)} ${unit}`.trim();
    },
    // Where something is now that was at `at` at the start and moves with a row of bodies; -1: with none.
    where({ at, row }) {
      if (row < 0) return at;
      const [k, part] = pointer(seen.animation, time);
      pose(seen, row, 0, 0);
      moved.fromArray(at).sub(position);
      pose(seen, row, k, part);
      return moved.add(position).toArray();
    },
    // Draws it once as it is printed, on a canvas that keeps it: what three.js draws on is blank in print.
    print(on, onto) {
      if (!on) { measure(); draw(); return; }
      [wide, high] = [onto.width / PRINTED_AT, onto.height / PRINTED_AT];
      drawn = 0;
      const held = [fineness, thin, camera.zoom];
      fineness = PRINTED_AT;
      ground();
      camera.zoom *= Math.min(1, (wide / high) / (canvas.clientWidth / canvas.clientHeight || 1));
      refreshPoses();
      draw();
      onto.getContext("2d").drawImage(canvas, 0, 0);
      [fineness, thin, camera.zoom] = held;
      drawn = 0;
    },
    // What is under a point of the canvas [px]: a mesh, or a box by its number; planes only where nothing else is.
    pick(x, y) {
      const ray = new THREE.Raycaster();
      const at = new THREE.Vector3(2 * x / wide - 1, 1 - 2 * y / high, 0).unproject(camera);
      ray.set(at.addScaledVector(away, 1e5), moved.copy(away).negate().clone());
      const hits = ray.intersectObjects([seen.boxes, ...seen.parts.filter((part) => part.drawn.visible).map((part) => part.drawn)], false);
      const found = hits.map((hit) => hit.object === seen.boxes ? { box: Math.floor(hit.faceIndex / 12) } : { mesh: seen.parts.find((part) => part.drawn === hit.object).mesh });
      return found.find((one) => one.mesh?.kind !== "plane") ?? found[0] ?? null;
    },
    seek(at) { time = at; refreshPoses(); refresh(); },
    // While it plays, a picture that takes too long [ms] is made coarser, since without a graphics card the
    // time goes by the pixel; at rest (null) it is as fine as the screen.
    pace(took) {
      const before = fineness;
      if (took === null) fineness = finest;
      else if (took > SLOW) fineness = Math.max(fineness * 0.8, COARSEST * finest);
      else if (took < SLOW / 3) fineness = Math.min(fineness * 1.1, finest);
      if (fineness !== before) refresh();
    },
    // draws at once and waits until it is done, for those who measure or take pictures: a pixel that is read
    // has been drawn, while finish() comes back at once
    now() { refreshPoses(); draw(); const gl = renderer.getContext(); gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); },
  };

  dark.addEventListener("change", () => { ground(); refresh(); });
  function measure() { wide = canvas.clientWidth; high = canvas.clientHeight; drawn = 0; ground(); }
  new ResizeObserver(() => { measure(); refresh(); }).observe(canvas);
  measure();
  return shown;
}
