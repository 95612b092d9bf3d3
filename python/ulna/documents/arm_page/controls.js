/* Sliders, views and highlights of the page. */
"use strict";
(function () {
  var data = JSON.parse(document.getElementById("arm-data").textContent);
  var svg = document.querySelector("#picture svg");
  var root = document.documentElement;
  var system = window.matchMedia("(prefers-color-scheme: dark)");
  var RAD = Math.PI / 180;
  var degrees = data.start.slice();
  var rows = Array.from(document.querySelectorAll("li.joint"));
  var view = { azimuth: data.view[0], elevation: data.view[1], zoom: 1, centre: [0, 0, 0], radius: 1 };
  var stand, waiting = false;

  var shapes = data.shapes.map(function (each) {
    return {
      kind: each[0], body: each[1], group: each[2], role: each[3], points: each[4], joint: each[5], text: each[6],
      radius: each[7]
    };
  });
  var draw = ArmPicture.make(svg, shapes);

  function place() {
    stand = ArmMap.bodies(data.before, data.turns, degrees.map(function (each) { return each * RAD; }));
  }

  function later() {
    if (waiting) { return; }
    waiting = true;
    requestAnimationFrame(function () { waiting = false; draw(stand, view); });
  }

  function fit() {
    var found = ArmPicture.extent(shapes, stand);
    view.centre = found.centre;
    view.radius = found.radius;
    view.zoom = 1;
  }

  function tell() {
    var tip = ArmMap.at(stand[stand.length - 1], data.tip[0], data.tip[1], data.tip[2]);
    var place = document.getElementById("tip");
    place.dataset.mm = tip.join(" ");
    ["x", "y", "z"].forEach(function (axis, k) {
      document.getElementById("tip-" + axis).textContent = tip[k].toFixed(3).replace(/^-(0\.0+)$/, "$1");
    });
    document.getElementById("pose").textContent = degrees.map(function (each) {
      return Number(each.toFixed(4));
    }).join(",");
    rows.forEach(function (row, k) {
      var low = data.limits[k][0], high = data.limits[k][1];
      row.classList.toggle("beyond", data.limited[k] && (degrees[k] < low - 1e-9 || degrees[k] > high + 1e-9));
    });
  }

  function changed() {
    place();
    tell();
    if (!draw(stand, view)) { fit(); draw(stand, view); }
  }

  function show(k) {
    rows[k].querySelector("[type=range]").value = degrees[k];
    rows[k].querySelector("[type=number]").value = Number(degrees[k].toFixed(4));
  }

  function set(all) {
    degrees = all.slice();
    degrees.forEach(function (_, k) { show(k); });
    changed();
  }

  rows.forEach(function (row, k) {
    var slider = row.querySelector("[type=range]"), entry = row.querySelector("[type=number]");
    slider.addEventListener("input", function () {
      degrees[k] = slider.valueAsNumber;
      entry.value = degrees[k];
      changed();
    });
    entry.addEventListener("input", function () {
      if (!isFinite(entry.valueAsNumber)) { return; }
      degrees[k] = entry.valueAsNumber;
      slider.value = degrees[k];
      changed();
    });
    entry.addEventListener("blur", function () { show(k); });
  });

  function button(id, work) { document.getElementById(id).addEventListener("click", work); }
  button("zero", function () { set(degrees.map(function () { return 0; })); });
  button("start", function () { set(data.start); });
  button("mirror", function () { set(degrees.map(function (each) { return 0 - each; })); });
  button("fit", function () { fit(); later(); });
  Array.from(document.querySelectorAll("[data-view]")).forEach(function (each) {
    each.addEventListener("click", function () {
      var angles = each.dataset.view.split(" ").map(Number);
      view.azimuth = angles[0] * RAD;
      view.elevation = angles[1] * RAD;
      fit();
      later();
    });
  });
  Array.from(document.querySelectorAll("[data-shown]")).forEach(function (each) {
    function apply() { svg.classList.toggle("without-" + each.dataset.shown, !each.checked); }
    each.addEventListener("change", apply);
    apply();
  });

  /* a joint, its link and its rows light up together */
  function light(joint) {
    Array.from(document.querySelectorAll(".lit")).forEach(function (each) { each.classList.remove("lit"); });
    if (joint) {
      Array.from(document.querySelectorAll('[data-joint="' + joint + '"]')).forEach(function (each) {
        each.classList.add("lit");
      });
    }
  }
  function jointOf(target) {
    var found = target.closest && target.closest("[data-joint]");
    return found ? found.dataset.joint : null;
  }
  document.addEventListener("mouseover", function (event) { if (!held.size) { light(jointOf(event.target)); } });
  document.addEventListener("focusin", function (event) { light(jointOf(event.target)); });

  /* one finger or the mouse turns, two fingers zoom and move; with Shift, or another button, the mouse moves */
  var held = new Map();
  function middle() {
    var all = Array.from(held.values()), sum = [0, 0];
    all.forEach(function (p) { sum[0] += p[0] / all.length; sum[1] += p[1] / all.length; });
    return { at: sum, apart: all.length > 1 ? Math.hypot(all[0][0] - all[1][0], all[0][1] - all[1][1]) : 0 };
  }
  function turn(right, down) {
    view.azimuth -= right;
    view.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, view.elevation + down));
  }
  function move(right, down) {
    var eye = ArmPicture.axes(view);
    view.centre = view.centre.map(function (each, i) {
      return each + (-right * eye[0][i] + down * eye[1][i]) / view.scale;
    });
  }
  function zoom(by) { view.zoom = Math.max(0.1, Math.min(50, view.zoom * by)); }

  svg.addEventListener("pointerdown", function (event) {
    held.set(event.pointerId, [event.clientX, event.clientY, event.shiftKey || event.button > 0]);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", function (event) {
    var own = held.get(event.pointerId);
    if (!own) { return; }
    var before = middle(), moves = own[2];
    held.set(event.pointerId, [event.clientX, event.clientY, moves]);
    var now = middle(), right = now.at[0] - before.at[0], down = now.at[1] - before.at[1];
    if (held.size > 1) {
      zoom(now.apart / Math.max(before.apart, 1));
      move(right, down);
    } else if (moves) {
      move(right, down);
    } else {
      turn(right * 0.008, down * 0.008);
    }
    later();
  });
  ["pointerup", "pointercancel"].forEach(function (kind) {
    svg.addEventListener(kind, function (event) { held.delete(event.pointerId); });
  });
  svg.setAttribute("tabindex", "0");
  svg.addEventListener("contextmenu", function (event) { event.preventDefault(); });
  svg.addEventListener("wheel", function (event) {
    event.preventDefault();
    zoom(Math.exp(-Math.max(-100, Math.min(100, event.deltaY)) * 0.002));
    later();
  }, { passive: false });
  var KEYS = {
    ArrowLeft: function () { turn(-0.1, 0); }, ArrowRight: function () { turn(0.1, 0); },
    ArrowUp: function () { turn(0, -0.1); }, ArrowDown: function () { turn(0, 0.1); },
    "+": function () { zoom(1.15); }, "=": function () { zoom(1.15); }, "-": function () { zoom(1 / 1.15); }, "0": fit
  };
  svg.addEventListener("keydown", function (event) {
    if (!KEYS[event.key] || event.ctrlKey || event.metaKey || event.altKey) { return; }
    event.preventDefault();
    KEYS[event.key]();
    later();
  });

  document.getElementById("theme").addEventListener("click", function () {
    var dark = root.dataset.theme ? root.dataset.theme === "dark" : system.matches;
    root.dataset.theme = dark ? "light" : "dark";
  });
  if (window.ResizeObserver) { new ResizeObserver(later).observe(svg); }
  window.addEventListener("resize", later);

  place();
  fit();
  set(data.start);
  root.dataset.ready = "yes";
})();
