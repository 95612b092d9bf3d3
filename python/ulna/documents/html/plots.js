/* Draws the plots of a report in the colours of the theme, and pictures of them for paper. */
"use strict";
(function () {
  var light = {
    main: "#0072b2", faint: "#a9cfe6", outlier: "#d55e00", second: "#009e73", undecided: "#9a6700", ink: "#1b1f24", grid: "#e3e7ec", axis: "#8a939e",
    paper: "#ffffff", band: "rgba(154,103,0,0.22)"
  };
  var dark = {
    main: "#56b4e9", faint: "#2b5875", outlier: "#ee7733", second: "#2fc39a", undecided: "#f0b429", ink: "#e7eaee", grid: "#2e353d", axis: "#77818d",
    paper: "#14171b", band: "rgba(240,180,41,0.25)"
  };
  var NARROW = 480;
  var root = document.documentElement;
  var system = window.matchMedia("(prefers-color-scheme: dark)");
  var plots = JSON.parse(document.getElementById("plot-data").textContent);
  /* only these buttons: Plotly has one that sends the readings to its maker's server */
  var flat = ["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"];
  var solid = ["orbitRotation", "zoom3d", "pan3d", "resetCameraDefault3d"];

  function configOf(plot) {
    return {
      responsive: true, displaylogo: false, plotlyServerURL: "", modeBarButtons: [plot.solid ? solid : flat]
    };
  }

  function isDark() {
    return root.dataset.theme ? root.dataset.theme === "dark" : system.matches;
  }

  /* a copy in which "@main" and the like are colours */
  function coloured(value, colours) {
    if (typeof value === "string") {
      return value.charAt(0) === "@" && colours[value.slice(1)] ? colours[value.slice(1)] : value;
    }
    if (Array.isArray(value)) {
      return value.map(function (each) { return coloured(each, colours); });
    }
    if (value && typeof value === "object") {
      var copy = {};
      Object.keys(value).forEach(function (key) { copy[key] = coloured(value[key], colours); });
      return copy;
    }
    return value;
  }

  function layoutOf(plot, colours) {
    var layout = coloured(plot.layout, colours);
    layout.paper_bgcolor = layout.plot_bgcolor = "rgba(0,0,0,0)";
    layout.font = { color: colours.ink, size: 12, family: getComputedStyle(document.body).fontFamily };
    layout.hoverlabel = { align: "left" };
    layout.modebar = { bgcolor: "rgba(0,0,0,0)", color: colours.axis, activecolor: colours.ink };
    return layout;
  }

  /* on a phone: a camera farther off, and no labels that would stand on each other; touching a cell tells its names */
  function narrowed(layout) {
    if (layout.scene) {
      ["x", "y", "z"].forEach(function (each) { layout.scene.camera.eye[each] *= 1.9; });
    }
    if (layout.xaxis && layout.xaxis.dtick === 1 && layout.xaxis.tickangle) { layout.xaxis.showticklabels = false; }
  }

  function draw(plot) {
    var colours = isDark() ? dark : light;
    var place = document.getElementById("plot-" + plot.name);
    var layout = layoutOf(plot, colours);
    if (place.clientWidth < NARROW) { narrowed(layout); }
    return Plotly.react(place, coloured(plot.data, colours), layout, configOf(plot));
  }

  /* printing starts when the browser says so, so the pictures are made before */
  function picture(plot) {
    var place = document.getElementById("plot-" + plot.name);
    var height = parseInt(place.style.height, 10);
    var width = place.closest(".grid") ? 430 : 860;
    var sheet = { data: coloured(plot.data, light), layout: layoutOf(plot, light) };
    var options = { format: plot.solid ? "png" : "svg", width: width, height: height };
    if (plot.solid) { options.scale = 2; }
    return Plotly.toImage(sheet, options).then(function (source) {
      var image = document.createElement("img");
      image.alt = "";
      image.src = source;
      place.appendChild(image);
      place.classList.add("pictured");
    });
  }

  /* one after the other, the page stays usable between them */
  function inTurn(work, then) {
    var k = 0;
    function next() {
      if (k >= plots.length) { if (then) { then(); } return; }
      var plot = plots[k++];
      Promise.resolve().then(function () { return work(plot); }).catch(function (error) {
        console.error(plot.name, error);
      }).then(function () { setTimeout(next, 0); });
    }
    next();
  }

  function redraw() { inTurn(draw); }

  document.getElementById("theme").addEventListener("click", function () {
    root.dataset.theme = isDark() ? "light" : "dark";
    redraw();
  });
  document.getElementById("print").addEventListener("click", function () { window.print(); });
  system.addEventListener("change", redraw);
  inTurn(draw, function () {
    inTurn(picture, function () { root.dataset.ready = "yes"; });
  });
})();
