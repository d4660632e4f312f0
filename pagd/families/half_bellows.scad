// A half-bellows bending actuator: half of a bellows on a flat base with a sheet of paper inside.
//
// Blow air in and the convolutions open; the paper keeps the base from stretching, so the bellows
// bends towards it.
//
// Show the Customizer (menu View or Window) and move the sliders. F5 draws, F6 computes the
// exact solid.
//
// Lengths are in mm. x runs along the axis of the bellows from the end that is held, y across,
// z up; z = 0 is the top of the base, and the paper lies half-way down in it.

/* [Convolutions] */

// Number of convolutions
N = 6; // [1:1:30]
// Pitch of the convolutions, along the axis
q = 11; // [4:0.01:30]
// Height of a convolution, crest above root
w = 4; // [1:0.01:20]
// Outer radius at the roots
R = 7; // [2:0.01:30]
// Length of a crest, outside
L_c = 5; // [1:0.01:20]
// Length of a root, outside
L_r = 2; // [0.5:0.01:20]

/* [Walls] */

// Wall of the convolutions, normal to it
t = 2; // [0.5:0.01:6]
// Walls at both ends, along the axis
t_e = 2; // [0.5:0.01:10]
// Base, with the paper half-way down
t_b = 3; // [1:0.01:12]
// Flange: what the base has beyond the crests, either side
b_f = 1; // [0.5:0.01:10]

/* [View] */

// All of it in colours to look at, or one part of it to export
part = "assembly"; // [assembly, body, base, cavity]
// Only the half with y > 0, which shows the inside
half = false;

/* [Hidden] */

// Facets of the half circle; an even number has corners in the plane of symmetry
facets = 16;


// ---- What follows from the parameters ----------------------------------------------------

L_T = N * q + 2 * t_e;
W = 2 * (R + w + b_f);
run = (q - L_c - L_r) / 2;                // extent of a flank along the axis
shift = t * tan(atan2(w, run) / 2);       // of a corner by the wall: crests shorten, roots lengthen

assert(run >= 0, "q: crest and root are longer than the pitch");
assert(R > t, "R: the wall leaves no room for air at the roots");
assert(L_c > 2 * shift, "L_c: the wall leaves no room for air at the crests");

// Corners [x, radius] of a convolution that begins at x: up a flank, and down the other. Outside
// with nothing taken off; inside with the wall `off` and the corners' shift `s`.
function convolution(x, off, s) = [
    [x + L_r / 2 + s, R - off], [x + L_r / 2 + run + s, R + w - off],
    [x + q - L_r / 2 - run - s, R + w - off], [x + q - L_r / 2 - s, R - off]
];
function profile(from, to, off, s) = concat(
    [[from, R - off]], [for (i = [0:N - 1]) each convolution(t_e + i * q, off, s)], [[to, R - off]]
);


// ---- The parts ---------------------------------------------------------------------------

// The half z > 0 of what a profile of corners [x, radius] gives when it turns about the x axis.
// Every corner is stated, so that faces meant to lie in one plane do so to the last digit:
// rotate_extrude() would round the profile.
module revolved(corners) {
    m = len(corners) - 1;
    n = facets;
    function at(i, k) = i * (n + 1) + k;
    polyhedron(
        points = [for (c = corners) for (k = [0:n])
            [c.x, c.y * cos(180 * k / n), c.y * sin(180 * k / n)]],
        faces = concat(
            [[for (k = [0:n]) at(0, k)]],
            [[for (k = [n:-1:0]) at(m, k)]],
            [concat([for (i = [0:m]) at(i, n)], [for (i = [m:-1:0]) at(i, 0)])],
            [for (i = [0:m - 1]) for (k = [0:n - 1])
                [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)]]
        )
    );
}

module slab(from, to) {
    translate([0, -W / 2, from]) cube([L_T, W, to - from]);
}

// All the air, in one piece.
module cavity() {
    revolved(profile(t_e, L_T - t_e, t, shift));
}

// Everything above the paper.
module body() {
    difference() {
        union() {
            revolved(profile(0, L_T, 0, 0));
            slab(-t_b / 2, 0);
        }
        cavity();
    }
}

// Everything below the paper.
module base() {
    slab(-t_b, -t_b / 2);
}

// The paper, drawn thicker and wider than it is so that it can be seen.
module paper() {
    translate([0, 0, 0.1]) scale([1, 1.01, 1]) slab(-t_b / 2 - 0.2, -t_b / 2);
}

// The children, or their half with y > 0. The box is cut with in both cases: OpenSCAD rounds a
// shape that no cut is made in to multiples of 1e-6 mm, and body and base would no longer meet.
module halved() {
    intersection() {
        children();
        translate([-q, half ? 0 : -W, -2 * t_b - W]) cube([L_T + 2 * q, 2 * W, 2 * W + 4 * t_b]);
    }
}

if (part == "body") halved() body();
else if (part == "base") halved() base();
else if (part == "cavity") halved() cavity();
else {
    color("LightSteelBlue") halved() body();
    color("SteelBlue") halved() base();
    color("Ivory") halved() paper();
}
