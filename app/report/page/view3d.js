// Deformed bodies that can be rotated. The drawing is three.js; the picture stays until someone asks for more.
(() => {
  'use strict';
  if (typeof THREE === 'undefined') return;

  /// Lists as they were before they were put into steps.
  function decoded(body) {
    for (const list of ['place_mm', 'displacement_mm', 'stress_MPa', 'faces']) {
      const {unit, stride, steps} = body[list];
      for (let i = stride; i < steps.length; ++i) steps[i] += steps[i - stride];
      body[list] = steps.map((step) => unit * step);
    }
    return body;
  }

  function surface(body) {
    const colours = body.colours.map((c) => new THREE.Color(c));
    const rgb = body.stress_MPa.flatMap((s) => {
      const level = Math.min(Math.max(Math.floor((s / body.top_MPa) * colours.length), 0), colours.length - 1);
      return colours[level].toArray();
    });
    const triangles = [], edges = [];
    for (let i = 0; i < body.faces.length; i += 4) {
      const [a, b, c, d] = body.faces.slice(i, i + 4);
      triangles.push(a, b, c, a, c, d);
      edges.push(a, b, b, c, c, d, d, a);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(body.place_mm, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(rgb, 3));
    geometry.setIndex(triangles);
    return {geometry, edges};
  }

  function place(geometry, body, exaggeration) {
    const position = geometry.getAttribute('position');
    for (let i = 0; i < body.place_mm.length; ++i)
      position.array[i] = body.place_mm[i] + exaggeration * body.displacement_mm[i];
    position.needsUpdate = true;
    geometry.computeVertexNormals();
  }

  function makeView(box, body) {
    const svg = box.querySelector('svg');
    const {width, height} = svg.getBoundingClientRect();
    const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(width, height);
    renderer.setClearColor(0xffffff);
    const {geometry, edges} = surface(body);
    place(geometry, body, body.exaggeration);
    const material = new (body.solid ? THREE.MeshLambertMaterial : THREE.MeshBasicMaterial)({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    const lines = new THREE.BufferGeometry();
    lines.setAttribute('position', geometry.getAttribute('position'));
    lines.setIndex(edges);
    const scene = new THREE.Scene();
    scene.add(new THREE.Mesh(geometry, material));
    scene.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.12})));
    scene.add(new THREE.AmbientLight(0xffffff, 0.65));
    geometry.computeBoundingSphere();
    const {center, radius} = geometry.boundingSphere;
    // The page axes of the picture are those of the scene: the eye looks along -z.
    const [x0, y0, w, h] = svg.getAttribute('viewBox').split(' ').map(Number);
    const camera = new THREE.OrthographicCamera(-w / 2, w / 2, h / 2, -h / 2, -20 * radius, 20 * radius);
    const middle = new THREE.Vector3(x0 + w / 2, -(y0 + h / 2), center.z);
    camera.position.copy(middle).add(new THREE.Vector3(0, 0, radius));
    const lamp = new THREE.DirectionalLight(0xffffff, 0.5);
    lamp.position.set(-0.6, 0.5, 1);
    camera.add(lamp, lamp.target);  // from beside the eye, wherever it looks
    scene.add(camera);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.target.copy(middle);
    controls.update();
    const draw = () => renderer.render(scene, camera);
    controls.addEventListener('change', draw);
    // Arrow keys rotate by a twentieth of a turn.
    const canvas = renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', svg.getAttribute('aria-label') + ', rotated by the arrow keys');
    canvas.addEventListener('keydown', (event) => {
      const turn = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (!turn) return;
      event.preventDefault();
      const offset = camera.position.clone().sub(controls.target), at = new THREE.Spherical().setFromVector3(offset);
      at.theta += turn[0] * Math.PI / 10;
      at.phi = Math.min(Math.max(at.phi - turn[1] * Math.PI / 10, 0.01), Math.PI - 0.01);
      camera.position.copy(controls.target).add(offset.setFromSpherical(at));
      controls.update();
      draw();
    });

    const slider = document.createElement('input');
    slider.type = 'range';
    slider.min = 0;
    slider.max = 3;
    slider.step = 0.01;
    slider.value = 1;
    slider.addEventListener('input', () => {
      place(geometry, body, slider.value * body.exaggeration);
      draw();
    });
    const label = document.createElement('label');
    label.className = 'tools shown';
    label.append('displacement ', slider, ' · drag or arrow keys: rotate · wheel: zoom · right button: shift');
    box.insertBefore(renderer.domElement, svg);
    box.append(label);
    box.classList.add('awake');
    draw();
    return {renderer, scene, camera, controls, slider, draw, geometry};
  }

  annulus.make('.view3d', (box) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'turn';
    button.textContent = 'Rotate (3-D)';
    button.addEventListener('click', () => {
      if (box.view) return;
      try {
        box.view = makeView(box, box.body());
        button.remove();
      } catch (error) {
        button.textContent = 'this browser has no WebGL: ' + error.message;
      }
    });
    box.append(button);
    box.body = () => decoded(annulus.numbers(box));
  });
})();
