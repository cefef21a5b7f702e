// The view of cameras and structure in space, drawn by three.js when something
// changed, not all the time.

class Space {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, .002, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.requestRender());
    this.depth = usualDepth();
    this.share = 1;  // of the way from before the adjustment to after it
    this.addShapes();
    this.fit();
    this.place();
    this.paint();
    this.show();
    samplePointColors(this.pointColors, () => this.paint());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  addObject(Type, material, numVertices, hasColors) {
    const geometry = new THREE.BufferGeometry();
    const attribute = () =>
        new THREE.BufferAttribute(new Float32Array(3 * numVertices), 3);
    geometry.setAttribute('position', attribute());
    if (hasColors) geometry.setAttribute('color', attribute());
    const object = new Type(geometry, material);
    object.frustumCulled = false;
    this.scene.add(object);
    return object;
  }

  addShapes() {
    const colored = { vertexColors: THREE.VertexColors || true };
    const ratio = window.devicePixelRatio || 1;
    const numViews = page.views.length;
    const pointSize = page.points.positions.length > 45000 ? 1.5 : 2.5;
    this.pointColors = new Uint8Array(page.points.positions.length);
    this.objects = {
      planes: this.addObject(
          THREE.Mesh,
          new THREE.MeshBasicMaterial({
            side: THREE.DoubleSide, transparent: true, depthWrite: false,
            opacity: Math.max(
                .02, Math.min(.2, 3 / (page.coplanarPairs.length + 1))),
          }),
          3 * page.coplanarPairs.length, false),
      points: this.addObject(
          THREE.Points,
          new THREE.PointsMaterial(
              { ...colored, size: pointSize * ratio, sizeAttenuation: false }),
          page.points.positions.length / 3, true),
      lines: this.addObject(THREE.LineSegments,
                            new THREE.LineBasicMaterial(
                                { ...colored, transparent: true, opacity: .7 }),
                            page.lines.positions.length / 3, true),
      links: this.addObject(
          THREE.LineSegments,
          new THREE.LineBasicMaterial(
              { ...colored, transparent: true, opacity: .55 }),
          2 * page.pairs.length, true),
      cameras: this.addObject(THREE.LineSegments,
                              new THREE.LineBasicMaterial(colored),
                              16 * numViews, true),
      truth: this.addObject(THREE.LineSegments,
                            new THREE.LineBasicMaterial(), 18 * numViews,
                            false),
    };
    this.addPictures();
  }

  // The photographs in the image planes; only of as many views as are quick.
  addPictures() {
    const most = 200;
    this.objects.pictures = new THREE.Group();
    this.scene.add(this.objects.pictures);
    this.pictures = page.views.slice(0, most).map(view => {
      if (!view.camera) return null;
      const material = new THREE.MeshBasicMaterial({
        side: THREE.DoubleSide, transparent: true, opacity: .18,
        depthWrite: false, color: cssColor('camera'),
      });
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute(
          'position', new THREE.BufferAttribute(new Float32Array(12), 3));
      geometry.setAttribute(
          'uv', new THREE.BufferAttribute(
                    new Float32Array([0, 1, 1, 1, 1, 0, 0, 0]), 2));
      geometry.setIndex([0, 2, 1, 0, 3, 2]);
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      this.objects.pictures.add(mesh);
      withPicture(view.index, picture => {
        material.map = new THREE.Texture(picture);
        material.map.minFilter = THREE.LinearFilter;
        material.map.needsUpdate = true;
        material.color.set('#ffffff');
        material.opacity = .92;
        material.needsUpdate = true;
        this.requestRender();
      });
      return mesh;
    });
  }

  changed(object, name) {
    object.geometry.attributes[name].needsUpdate = true;
    this.requestRender();
  }

  positionsOf(name) {
    return this.objects[name].geometry.attributes.position.array;
  }

  // Fills all positions, at the present stage.
  place() {
    mixPositions(this.positionsOf('points'), page.points, this.share);
    const lines = this.positionsOf('lines');
    mixPositions(lines, page.lines, this.share);
    const planes = this.positionsOf('planes');
    for (let n = 0; n < page.coplanarPairs.length / 2; ++n) {
      writeQuad(planes, 18 * n, lines, page.coplanarPairs[2 * n],
                page.coplanarPairs[2 * n + 1]);
    }
    const cameras = this.positionsOf('cameras');
    const truth = this.positionsOf('truth');
    page.views.forEach((view, n) => {
      const camera = cameraAt(n, this.share);
      if (camera) {
        writeFrustum(cameras, 48 * n, camera, this.depth);
        const mesh = this.pictures[n];
        if (mesh) {
          mesh.geometry.attributes.position.array.set(
              imagePlane(camera, this.depth));
          this.changed(mesh, 'position');
        }
      }
      if (view.camera_true) {
        writeFrustum(truth, 54 * n, view.camera_true, this.depth);
        truth.set(view.camera_true.center, 54 * n + 48);
        truth.set((camera || view.camera_true).center, 54 * n + 51);
      }
    });
    const links = this.positionsOf('links');
    page.pairs.forEach((pair, n) => {
      const [from, to] = pair.views.map(view => cameraAt(view, this.share));
      if (!from || !to) return;
      links.set(from.center, 6 * n);
      links.set(to.center, 6 * n + 3);
    });
    for (const name of ['points', 'lines', 'planes', 'cameras', 'truth',
                        'links']) {
      this.changed(this.objects[name], 'position');
    }
  }

  fillColors(name, count, colorOf) {
    const colors = this.objects[name].geometry.attributes.color.array;
    const color = new THREE.Color();
    for (let n = 0; n < count; ++n) {
      colorOf(n, color);
      color.toArray(colors, 3 * n);
    }
    this.changed(this.objects[name], 'color');
  }

  // Fills all colours: what the selected views see stands out.
  paint() {
    const views = selectedViews();
    const least = Math.min(2, views.length);
    const theme = {};
    for (const name of ['point', 'line', 'plane', 'camera', 'truth', 'rule',
                        'accent', 'bad', 'faint', 'space']) {
      theme[name] = new THREE.Color(cssColor(name));
    }
    this.renderer.setClearColor(theme.space);
    this.objects.planes.material.color.copy(theme.plane);
    this.objects.truth.material.color.copy(theme.truth);
    const paintLandmarks = (name, member, plainColor, chosenColor, ends) => {
      const count = page[name].positions.length / (3 * ends);
      const observers = countObservers(views, member, count);
      this.fillColors(name, count * ends, (n, color) => {
        const landmark = Math.floor(n / ends);
        if (views.length === 0) {
          plainColor(landmark, color);
        } else if (observers[landmark] >= least) {
          color.copy(chosenColor);
        } else {
          color.copy(theme.rule);
        }
      });
    };
    const sampled = this.pointColors;
    paintLandmarks('points', 'landmarks', (n, color) => {
      const [r, g, b] = sampled.subarray(3 * n, 3 * n + 3);
      if (r + g + b === 0) {
        color.copy(theme.point);
      } else {
        color.setRGB(r / 255, g / 255, b / 255);
      }
    }, theme.point, 1);
    paintLandmarks('lines', 'lines', (n, color) => color.copy(theme.line),
                   theme.line, 2);
    this.fillColors('cameras', 16 * page.views.length, (n, color) => {
      const view = page.views[n >> 4];
      color.copy(views.includes(view.index) ? theme.bad
                 : view.warnings.length > 0 ? theme.line : theme.camera);
    });
    this.fillColors('links', 2 * page.pairs.length, (n, color) => {
      const pair = page.pairs[n >> 1];
      if (pair.used) {
        color.set(evidenceColor(pair.log10_nfa));
      } else {
        color.copy(theme.space);
      }
    });
    this.requestRender();
  }

  show() {
    for (const [name, object] of Object.entries(this.objects)) {
      object.visible = state.shown[name];
    }
    this.requestRender();
  }

  fit() {
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(1, -1.8, 1.5);
    this.camera.fov = 45;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  // From the place of a camera, into its direction.
  lookThrough(view) {
    const camera = cameraAt(view, this.share);
    const center = new THREE.Vector3(...camera.center);
    const axis = new THREE.Vector3();
    const corners = [0, 3, 6, 9].map(
        n => new THREE.Vector3(...camera.corners.slice(n, n + 3)));
    corners.forEach(corner => axis.addScaledVector(corner, .25));
    const half = corners[0].clone().add(corners[1]).multiplyScalar(.5);
    this.camera.position.copy(center);
    this.controls.target.copy(center).addScaledVector(axis, .05);
    this.camera.fov = 2.2 * half.angleTo(axis) * 180 / Math.PI;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  // Glides to the stage that is chosen.
  moveToStage() {
    const goal = state.stage === 'after' ? 1 : 0;
    const from = this.share;
    const start = performance.now();
    const step = () => {
      const done = Math.min(1, (performance.now() - start) / 450);
      this.share = from + (goal - from) * done;
      this.place();
      if (done < 1) requestAnimationFrame(step);
    };
    step();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } =
        this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  requestRender() {
    if (this.isRequested) return;
    this.isRequested = true;
    requestAnimationFrame(() => this.render());
  }

  render() {
    this.isRequested = false;
    this.renderer.render(this.scene, this.camera);
  }
}

let space = null;

function makeStageChoice() {
  const buttons = ['before', 'after'].map(stage => make('button', {
    id: `stage-${stage}`, onclick: () => setStage(stage),
    title: `${stage} the adjustment`,
  }, stage));
  const show = () => {
    for (const button of buttons) {
      button.setAttribute('aria-pressed', button.id === `stage-${state.stage}`);
    }
  };
  listen('stage', show);
  show();
  return make('span', { class: 'choice' }, buttons);
}

function startSpace() {
  const section = document.getElementById('space');
  const say = text => section.append(make('p', { class: 'empty' }, text));
  if (typeof THREE === 'undefined') {
    say('There is no view of the space here, since this lowlap was built ' +
        'without three.js (Debian: libjs-three).');
    return;
  }
  const canvas = make('canvas', { id: 'space-canvas' });
  section.append(canvas);
  try {
    space = new Space(canvas);
  } catch (error) {
    canvas.remove();
    say('There is no view of the space here, since this browser has no ' +
        `WebGL: ${error.message}`);
    return;
  }
  section.append(
      make('div', { class: 'toolbar' },
           makeToggle('shown', 'points', 'points', 'point'),
           makeToggle('shown', 'lines', 'lines', 'line'),
           page.coplanarPairs.length > 0 &&
               makeToggle('shown', 'planes', 'coplanar', 'plane'),
           makeToggle('shown', 'cameras', 'cameras', 'camera'),
           makeToggle('shown', 'pictures', 'images', 'camera'),
           makeToggle('shown', 'links', 'poses'),
           page.hasTruth && makeToggle('shown', 'truth', 'truth', 'truth'),
           make('span', { class: 'gap' }),
           page.hasBefore && makeStageChoice(),
           make('button', { id: 'fit', onclick: () => space.fit() }, 'fit')),
      make('div', { class: 'hint' },
           'drag to turn, scroll to zoom, right button to move, click a camera'));
  canvas.addEventListener('mousedown', rememberPress);
  canvas.addEventListener('click', pickCamera);
  listen('shown', () => space.show());
  listen('selected', () => space.paint());
  listen('stage', () => space.moveToStage());
  matchMedia('(prefers-color-scheme: dark)')
      .addEventListener('change', () => space.paint());
}
