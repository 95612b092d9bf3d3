/* Draws the shapes of an arm as SVG, seen in parallel projection; as `ulna.pictures.view` does for paper. */
"use strict";
var ArmPicture = (function () {
  var SVG = "http://www.w3.org/2000/svg";
  var ORDER = { floor: 0, arm: 1, over: 2, word: 3 };
  var ON_TOP = { word: "word", ball: "over" };
  var LEAST_BALL = 3.5, NAME = 4, FILLED = 0.54;
  var TAGS = { line: "path", solid: "path", face: "path", ball: "circle", word: "text" };

  function px(value) { return value.toFixed(1).replace(/\.0$/, ""); }

  function path(points, closed) {
    return "M" + points.map(function (p) { return px(p[0]) + " " + px(p[1]); }).join("L") + (closed ? "Z" : "");
  }

  /* corners of the convex hull, by Andrew's monotone chain */
  function hull(points) {
    var sorted = points.slice().sort(function (a, b) { return a[0] - b[0] || a[1] - b[1]; });
    function run(all) {
      var kept = [];
      all.forEach(function (c) {
        while (kept.length > 1) {
          var a = kept[kept.length - 2], b = kept[kept.length - 1];
          if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0) { break; }
          kept.pop();
        }
        kept.push(c);
      });
      kept.pop();
      return kept;
    }
    return run(sorted).concat(run(sorted.slice().reverse()));
  }

  function area(points) {
    return points.reduce(function (sum, p, k) {
      var next = points[(k + 1) % points.length];
      return sum + p[0] * next[1] - next[0] * p[1];
    }, 0);
  }

  /* kind of shape → how its mark is set; false where it is not seen */
  var SET = {
    line: function (mark, seen) { mark.setAttribute("d", path(seen)); },
    solid: function (mark, seen) { mark.setAttribute("d", path(hull(seen), true)); },
    face: function (mark, seen) {
      if (area(seen) >= 0) { return false; }
      mark.setAttribute("d", path(seen, true));
      return true;
    },
    ball: function (mark, seen, shape, scale) {
      mark.setAttribute("cx", px(seen[0][0]));
      mark.setAttribute("cy", px(seen[0][1]));
      mark.setAttribute("r", px(Math.max(shape.radius * scale, LEAST_BALL)));
    },
    word: function (mark, seen) {
      mark.setAttribute("x", px(seen[0][0]));
      mark.setAttribute("y", px(seen[0][1] - NAME));
    }
  };

  function element(shape) {
    var mark = document.createElementNS(SVG, TAGS[shape.kind]);
    mark.setAttribute("class", shape.role + " in-" + shape.group);
    if (shape.joint) { mark.dataset.joint = shape.joint; }
    if (shape.kind === "word") {
      mark.setAttribute("text-anchor", "middle");
      mark.textContent = shape.text;
    }
    return mark;
  }

  /* to the right, up, towards the eye */
  function axes(view) {
    var ca = Math.cos(view.azimuth), sa = Math.sin(view.azimuth);
    var ce = Math.cos(view.elevation), se = Math.sin(view.elevation);
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  }

  function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  function world(shape, stand) {
    var t = stand[shape.body], found = [];
    for (var k = 0; k < shape.points.length; k += 3) {
      found.push(ArmMap.at(t, shape.points[k], shape.points[k + 1], shape.points[k + 2]));
    }
    return found;
  }

  /* the middle of the arm, and how far its farthest part is from there */
  function extent(shapes, stand) {
    var low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity], all = [];
    shapes.forEach(function (shape) {
      if (["arm", "axes", "frames"].indexOf(shape.group) >= 0) { all = all.concat(world(shape, stand)); }
    });
    all.forEach(function (p) {
      for (var i = 0; i < 3; i += 1) { low[i] = Math.min(low[i], p[i]); high[i] = Math.max(high[i], p[i]); }
    });
    var centre = low.map(function (each, i) { return (each + high[i]) / 2; });
    var radius = Math.max.apply(null, all.map(function (p) {
      return Math.hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
    }));
    return { centre: centre, radius: radius };
  }

  /* 1, 2 or 5 times a power of ten, not above */
  function round(about) {
    var power = Math.pow(10, Math.floor(Math.log10(about)));
    return power * [5, 2, 1].filter(function (step) { return step * power <= about * (1 + 1e-9); })[0];
  }

  function make(svg, shapes) {
    var marks = shapes.map(element), last = "";
    var bar = element({ kind: "line", role: "scale", group: "arm" });
    var length = element({ kind: "word", role: "scale-name", group: "arm", text: "" });
    svg.replaceChildren();
    svg.append(bar, length);

    function scaleBar(scale, width, height) {
      var mm = round(0.2 * width / scale), end = 14 + mm * scale, y = height - 14;
      bar.setAttribute("d", path([[14, y - 5], [14, y], [end, y], [end, y - 5]]));
      length.textContent = Number(mm.toPrecision(6)) + " mm";
      SET.word(length, [[(14 + end) / 2, y - 4]]);
    }

    /* whether all of the arm is within the picture */
    return function draw(stand, view) {
      var box = svg.getBoundingClientRect();
      var width = Math.round(box.width), height = Math.round(box.height), eye = axes(view), inside = true;
      if (!width || !height) { return true; }
      var scale = view.zoom * FILLED * Math.min(width, height) / view.radius;
      svg.setAttribute("viewBox", "0 0 " + width + " " + height);
      view.scale = scale;
      var order = shapes.map(function (shape, k) {
        var depth = 0, points = world(shape, stand);
        var seen = points.map(function (p) {
          var from = [p[0] - view.centre[0], p[1] - view.centre[1], p[2] - view.centre[2]];
          depth += dot(from, eye[2]) / points.length;
          return [width / 2 + scale * dot(from, eye[0]), height / 2 - scale * dot(from, eye[1])];
        });
        var shown = SET[shape.kind](marks[k], seen, shape, scale) !== false;
        marks[k].style.visibility = shown ? "" : "hidden";
        if (shape.group === "arm") {
          inside = inside && seen.every(function (p) { return p[0] > 0 && p[1] > 0 && p[0] < width && p[1] < height; });
        }
        var layer = ON_TOP[shape.kind] || (shape.group in ORDER ? shape.group : "over");
        return [ORDER[layer], depth, k];
      });
      order.sort(function (a, b) { return a[0] - b[0] || a[1] - b[1] || a[2] - b[2]; });
      var now = order.map(function (each) { return each[2]; });
      if (now.join() !== last) {
        now.forEach(function (k) { svg.insertBefore(marks[k], bar); });
        last = now.join();
      }
      scaleBar(scale, width, height);
      return inside;
    };
  }

  return { make: make, extent: extent, axes: axes };
})();
