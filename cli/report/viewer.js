// Two surfaces that are turned together; a point of one marks its match on the other.
"use strict";

(function () {
  const START = {yaw: -0.66, pitch: 0.35, distance: 3.7};
  const MARK = 0xd6246e;

  function bytesOf(box, name) {
    const text = atob(box.querySelector('[data-name="' + name + '"]').textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes.buffer;
  }

  function surfaceOf(box, name) {
    const geometry = new THREE.BufferGeometry();
    const colours = new Uint8Array(bytesOf(box, name + "-colours"));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytesOf(box, name + "-faces")), 1));
    geometry.setAttribute(
      "position", new THREE.BufferAttribute(new Float32Array(bytesOf(box, name + "-points")), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3, true));
    geometry.computeVertexNormals();
    const material = new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide});
    const mesh = new THREE.Mesh(geometry, material);
    const mark = new THREE.Mesh(new THREE.SphereGeometry(0.035, 24, 16), new THREE.MeshBasicMaterial({color: MARK}));
    mark.visible = false;
    const scene = new THREE.Scene();
    scene.add(mesh, mark, new THREE.HemisphereLight(0xffffff, 0xb5b0a8, 0.8));
    const lamp = new THREE.DirectionalLight(0xffffff, 0.4);
    scene.add(lamp);
    return {scene, mesh, mark, lamp, points: geometry.getAttribute("position").array};
  }

  // The number of the point nearest to (x, y, z); points that are not numbers are never near.
  function nearest(points, at) {
    let best = -1, least = Infinity;
    for (let i = 0; i < points.length; i += 3) {
      const x = points[i] - at.x, y = points[i + 1] - at.y, z = points[i + 2] - at.z;
      const distance = x * x + y * y + z * z;
      if (distance < least) { least = distance; best = i; }
    }
    return best;
  }

  function start(box) {
    const canvas = box.querySelector("canvas");
    const renderer = new THREE.WebGLRenderer({canvas, alpha: true, antialias: true});
    const surfaces = [surfaceOf(box, "source"), surfaceOf(box, "target")];
    const images = new Float32Array(bytesOf(box, "images"));
    const camera = new THREE.PerspectiveCamera(32, 1, 0.1, 50);
    const view = Object.assign({}, START);
    const caster = new THREE.Raycaster();
    let isAsked = false;

    function aim(side) {
      const flat = Math.cos(view.pitch) * view.distance;
      camera.position.set(-Math.sin(view.yaw) * flat, Math.sin(view.pitch) * view.distance, Math.cos(view.yaw) * flat);
      camera.lookAt(0, 0, 0);
      camera.updateMatrixWorld();
      // A lamp above the viewer's left shoulder.
      surfaces[side].lamp.position.set(-1, 1.4, 1).applyQuaternion(camera.quaternion);
    }

    // The place of a surface on the canvas: side by side, or on a narrow one above each other.
    function place(side) {
      const width = canvas.clientWidth, height = canvas.clientHeight;
      if (width > height) return {x: side * width / 2, y: 0, width: width / 2, height};
      return {x: 0, y: side * height / 2, width, height: height / 2};
    }

    function draw() {
      isAsked = false;
      const width = canvas.clientWidth, height = canvas.clientHeight;
      if (width === 0 || height === 0) return;
      renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
      renderer.setSize(width, height, false);
      renderer.setScissorTest(true);
      camera.aspect = place(0).width / place(0).height;
      // On a narrow half the shape must fit its width.
      camera.fov = camera.aspect >= 1 ? 32 : 2 * Math.atan(Math.tan(16 * Math.PI / 180) / camera.aspect) * 180 / Math.PI;
      camera.updateProjectionMatrix();
      for (let side = 0; side < 2; side++) {
        const at = place(side), low = height - at.y - at.height;
        renderer.setViewport(at.x, low, at.width, at.height);
        renderer.setScissor(at.x, low, at.width, at.height);
        aim(side);
        renderer.render(surfaces[side].scene, camera);
      }
      box.dataset.drawn = "yes";
    }

    function ask() {
      if (!isAsked) { isAsked = true; requestAnimationFrame(draw); }
    }

    function turn(yaw, pitch) {
      view.yaw += yaw;
      view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + pitch));
      ask();
    }

    function zoom(factor) {
      view.distance = Math.max(1.6, Math.min(9, view.distance * factor));
      ask();
    }

    function reset() {
      Object.assign(view, START);
      ask();
    }

    // Marks what lies under the pointer, and its match.
    function mark(event) {
      const area = canvas.getBoundingClientRect();
      const x = event.clientX - area.left, y = event.clientY - area.top;
      const second = place(1);
      const side = x >= second.x && y >= second.y ? 1 : 0;
      const at = place(side);
      aim(side);
      caster.setFromCamera(
        new THREE.Vector2((x - at.x) / at.width * 2 - 1, 1 - (y - at.y) / at.height * 2), camera);
      const hit = caster.intersectObject(surfaces[side].mesh)[0];
      const from = surfaces[side], to = surfaces[1 - side];
      const i = hit ? nearest(side === 0 ? from.points : images, hit.point) : -1;
      const goal = side === 0 ? images : to.points;
      from.mark.visible = Boolean(hit);
      to.mark.visible = i >= 0 && !isNaN(goal[i]);
      if (hit) from.mark.position.copy(hit.point);
      if (to.mark.visible) to.mark.position.set(goal[i], goal[i + 1], goal[i + 2]);
      box.dataset.marked = to.mark.visible ? "yes" : "no";
      ask();
    }

    let held = null;
    canvas.addEventListener("pointerdown", function (event) {
      held = {x: event.clientX, y: event.clientY};
      canvas.setPointerCapture(event.pointerId);
      mark(event);
    });
    canvas.addEventListener("pointermove", function (event) {
      if (!held) { mark(event); return; }
      const speed = 3.2 / canvas.clientHeight;
      turn((event.clientX - held.x) * -speed, (event.clientY - held.y) * speed);
      held = {x: event.clientX, y: event.clientY};
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, function () { held = null; });
    // The wheel scrolls the page, unless the view was chosen.
    canvas.addEventListener("wheel", function (event) {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.003));
    }, {passive: false});
    const keys = {
      ArrowLeft: () => turn(0.15, 0), ArrowRight: () => turn(-0.15, 0), ArrowUp: () => turn(0, 0.15),
      ArrowDown: () => turn(0, -0.15), "+": () => zoom(0.87), "=": () => zoom(0.87), "-": () => zoom(1.15),
      "0": reset
    };
    canvas.addEventListener("keydown", function (event) {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });
    const actions = {closer: () => zoom(0.8), farther: () => zoom(1.25), reset};
    for (const button of box.querySelectorAll("button")) {
      button.addEventListener("click", actions[button.dataset.action]);
    }
    canvas.addEventListener("webglcontextlost", function () { box.dataset.state = "still"; });
    window.addEventListener("resize", ask);
    box.dataset.state = "live";
    draw();
  }

  function has3d() {
    const gl = document.createElement("canvas").getContext("webgl");
    const has = gl !== null && gl.getExtension("OES_element_index_uint") !== null;
    const loser = gl && gl.getExtension("WEBGL_lose_context");
    if (loser) loser.loseContext();
    return has;
  }

  for (const box of document.querySelectorAll(".viewer")) {
    try {
      if (has3d()) start(box);
    } catch (failure) {
      // The pictures stay.
      box.dataset.state = "still";
    }
  }
})();
