/* Where the bodies of an arm stand: products of constant transforms, which come with the page, and a turn about z at
   each joint. This is all that the page computes of an arm; a test holds it to the core's forward map.
   A transform is the first three rows of its matrix, 12 numbers row by row, in mm. */
"use strict";
var ArmMap = (function () {
  /* a · b */
  function product(a, b) {
    var out = new Array(12);
    for (var i = 0; i < 12; i += 4) {
      for (var j = 0; j < 4; j += 1) {
        out[i + j] = a[i] * b[j] + a[i + 1] * b[4 + j] + a[i + 2] * b[8 + j] + (j === 3 ? a[i + 3] : 0);
      }
    }
    return out;
  }

  /* t · Rz(angle) */
  function turned(t, angle) {
    var c = Math.cos(angle), s = Math.sin(angle);
    return product(t, [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0]);
  }

  /* A point of a body's frame, in the base frame. */
  function at(t, x, y, z) {
    return [0, 4, 8].map(function (i) { return t[i] * x + t[i + 1] * y + t[i + 2] * z + t[i + 3]; });
  }

  /* before: what stands before each joint, and behind the last; turns: how far each joint turns for a unit of each
     encoder, a row for each joint; q: the encoders' angles, rad.
     The base itself, then each body that turns with joint 1, 2, …; last the frame in which the tip stands. */
  function bodies(before, turns, q) {
    var found = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]];
    for (var k = 0; k < q.length; k += 1) {
      var angle = 0;
      for (var j = 0; j < q.length; j += 1) { angle += turns[k][j] * q[j]; }
      found.push(turned(product(found[k], before[k]), angle));
    }
    found.push(product(found[q.length], before[q.length]));
    return found;
  }

  return { bodies: bodies, at: at };
})();
if (typeof module !== "undefined") { module.exports = ArmMap; }
