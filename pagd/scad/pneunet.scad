// A pneu-net: a row of air chambers on a base with a sheet of paper inside.
//
// Blow air in and the chambers push each other apart; the paper keeps the base from
// stretching, so the row bends towards it. Slanted ("helical") chambers make it twist as well.
//
// Show the Customizer (menu View or Window) and move the sliders. F5 draws, F6 computes the
// exact solid.
//
// Lengths are in mm, angles in degrees. x runs along the row from the end that is held, y
// across, z up; z = 0 is the top of the base, and the paper lies half-way down in it.

/* [Chambers] */

// Outer length of a chamber, along the row
L = 8.01; // [3:0.01:20]
// Outer width of a chamber, across the row
W = 15.12; // [5:0.01:40]
// Height of a chamber above the base
H = 12.98; // [4:0.01:40]
// Number of chambers
N = 12; // [1:1:30]

/* [Walls] */

// Side walls
t = 1.49; // [0.5:0.01:10]
// Roof of a chamber
t_h = 4.07; // [0.5:0.01:10]
// Walls that face the neighbouring chambers, measured normal to them
t_ab = 2.05; // [0.5:0.01:6]
// Gap between two chambers, along the row
t_n = 2.8; // [0.5:0.01:8]
// Base, with the paper half-way down
t_b = 1.97; // [1:0.01:12]

/* [Slant] */

// Slant of the helical chambers
theta = 27.2; // [0:0.1:45]
// Share of the chambers that are helical, counted from the held end
alpha = 0.5; // [0:0.01:1]

/* [Air channel] */

// Width of the channel from the first cavity to the last
channel_width = 2; // [0.5:0.1:10]
// Height of the channel; it runs on the base
channel_height = 2; // [0.5:0.1:10]
// Roof of the channel: channel and roof are the floor of the gaps
channel_roof = 1.5; // [0.5:0.1:5]

/* [View] */

// All of it in colours to look at, or one part of it to export
part = "assembly"; // [assembly, body, base, cavity, mould_outside, mould_core, mould_base]
// Only the half with y > 0, which shows the inside
half = false;

/* [Moulds] */

// Walls and floors of the moulds
mould_wall = 6; // [4:0.5:20]
// Pegs of the core and their holes in the outer mould: diameter
peg = 3; // [1:0.5:8]
// Play between peg and hole, in the diameter
peg_play = 0.4; // [0:0.05:1]

/* [Hidden] */

// Sizes that differ along the row: one gap behind each chamber but the last, one base
// thickness under the middle of each chamber. Empty: t_n and t_b everywhere.
t_n_each = [];
t_b_each = [];


// ---- What follows from the parameters ----------------------------------------------------

N1 = floor(alpha * N + 0.5);                // helical chambers; the other N - N1 are straight
half_skew = N1 > 0 ? W / 2 * tan(theta) : 0; // how far a slanted corner runs ahead
gap_floor = channel_height + channel_roof;
L_T = start(N - 1) + L + skew(N - 1) * W / 2;
// As wide as the channel means exactly as wide: 3.76 - 2 * 0.88 is a hair under 2.
cavity_width = abs(W - 2 * t - channel_width) < 1e-9 ? channel_width : W - 2 * t;

function is_helical(i) = i < N1;
function skew(i) = is_helical(i) ? tan(theta) : 0;             // dx/dy of chamber i
function wall(i) = is_helical(i) ? t_ab / cos(theta) : t_ab;   // extent of t_ab along x
function gap(i) = len(t_n_each) > 0 ? t_n_each[i] : t_n;

// Where chamber i starts, at y = 0. The first straight chamber after the helical ones keeps
// another half-skew away, so that it clears the corner of the last helical one.
function start(i) = i == 0 ? half_skew
    : start(i - 1) + L + gap(i - 1) + (i == N1 ? half_skew : 0);
function middle(i) = start(i) + L / 2;

// Thickness of the base as points [x, thickness] along the row.
base_line = len(t_b_each) == 0 ? [[0, t_b], [L_T, t_b]]
    : [[0, t_b_each[0]], for (i = [0:N - 1]) [middle(i), t_b_each[i]], [L_T, t_b_each[N - 1]]];

for (i = [0:N - 1])
    assert(L > 2 * wall(i), "L: the walls t_ab leave no room for air");
assert(cavity_width >= channel_width, "W: the side walls leave no room for the channel");
assert(H - t_h > channel_height, "H: the roof reaches down into the channel");
assert(H > gap_floor, "H: the chambers do not stand out above the floor of the gaps");


// ---- Two shapes --------------------------------------------------------------------------
// Both state every corner, so that faces meant to lie in one plane do so to the last digit:
// no slivers, and nothing to fudge.

// A box from x0 to x1 (at y = 0), |y| < width / 2, z0 to z1, whose ends follow x + skew_*y.
module sheared_box(x0, x1, width, z0, z1, skew0, skew1) {
    y = width / 2;
    outline = [
        [x0 - skew0 * y, -y], [x1 - skew1 * y, -y], [x1 + skew1 * y, y], [x0 + skew0 * y, y]
    ];
    prism([for (p = outline) [p.x, p.y, z0]], [for (p = outline) [p.x, p.y, z1]]);
}

// The solid between two equal polygons; from outside, the first one is seen anticlockwise.
module prism(first, second) {
    n = len(first);
    polyhedron(
        points = concat(first, second),
        faces = concat(
            [[for (k = [0:n - 1]) k]],
            [[for (k = [n - 1:-1:0]) n + k]],
            [for (k = [0:n - 1]) [k, n + k, n + (k + 1) % n, (k + 1) % n]]
        )
    );
}

// A solid across the full width, between two lines of points [x, z].
module plate(upper, lower) {
    n = len(upper);
    outline = concat(lower, [for (k = [n - 1:-1:0]) upper[k]]);
    prism([for (p = outline) [p.x, W / 2, p.y]], [for (p = outline) [p.x, -W / 2, p.y]]);
}


// ---- The parts ---------------------------------------------------------------------------

// All the air in one piece: a box in each chamber, and the channel. The channel ends in the
// middle of the first and the last cavity, parallel to their walls, so that it never comes
// out of them on the far side.
module cavity() {
    for (i = [0:N - 1])
        sheared_box(start(i) + wall(i), start(i) + L - wall(i), cavity_width, 0, H - t_h,
                    skew(i), skew(i));
    if (N > 1)
        sheared_box(middle(0), middle(N - 1), channel_width, 0, channel_height,
                    skew(0), skew(N - 1));
}

// The chambers as solid blocks, on a slab from the paper up to the floor of the gaps.
module blocks() {
    plate([for (p = base_line) [p.x, gap_floor]], [for (p = base_line) [p.x, -p.y / 2]]);
    for (i = [0:N - 1])
        sheared_box(start(i), start(i) + L, W, 0, H, skew(i), skew(i));
}

// Everything above the paper.
module body() {
    difference() {
        blocks();
        cavity();
    }
}

// Everything below the paper.
module base() {
    plate([for (p = base_line) [p.x, -p.y / 2]], [for (p = base_line) [p.x, -p.y]]);
}

// The paper, drawn thicker and wider than it is so that it can be seen.
module paper() {
    translate([0, 0, 0.1]) scale([1, 1.01, 1])
        plate([for (p = base_line) [p.x, -p.y / 2]], [for (p = base_line) [p.x, -p.y / 2 - 0.2]]);
}

// The children, or their half with y > 0. The box is cut with in both cases: OpenSCAD rounds a
// shape that no cut is made in to multiples of 1e-6 mm, and body and base would no longer meet.
module halved() {
    intersection() {
        children();
        translate([-L, half ? 0 : -W, -2 * (H + t_b)]) cube([L_T + 2 * L, 2 * W, 4 * (H + t_b)]);
    }
}


// ---- Moulds ------------------------------------------------------------------------------
// The chambers are cast without the base, upside down and open: the outer mould, filled to its
// rim, and the core, which is pressed into it and leaves the air. The base is cast on its own, with
// the paper laid in when it is half full, and glued to the chambers' rim at z = 0. All parts come
// straight out: nothing is undercut along z.

// Outline of the moulds with walls, between two heights.
module mould_block(low, high) {
    translate([-mould_wall, -W / 2 - mould_wall, low])
        cube([L_T + 2 * mould_wall, W + 2 * mould_wall, high - low]);
}

// In the four corners, from z = 0 up.
module pegs(diameter, height) {
    for (x = [-mould_wall / 2, L_T + mould_wall / 2], y = [-1, 1])
        translate([x, y * (W + mould_wall) / 2, 0])
            cylinder(d = diameter, h = height, $fn = 48);
}

// Around the chambers, above the base.
module mould_outside() {
    difference() {
        mould_block(0, H + mould_wall);
        plate([for (p = base_line) [p.x, gap_floor]], [for (p = base_line) [p.x, 0]]);
        for (i = [0:N - 1])
            sheared_box(start(i), start(i) + L, W, 0, H, skew(i), skew(i));
        pegs(peg + peg_play, mould_wall);
    }
}

// The air on a plate, with pegs a little shorter than their holes.
module mould_core() {
    union() {
        mould_block(-mould_wall, 0);
        cavity();
        pegs(peg, mould_wall - 1);
    }
}

// A tray as deep as the base is thick.
module mould_base() {
    difference() {
        mould_block(-max([for (p = base_line) p.y]) - mould_wall, 0);
        plate([for (p = base_line) [p.x, 0]], [for (p = base_line) [p.x, -p.y]]);
    }
}

if (part == "body") halved() body();
else if (part == "base") halved() base();
else if (part == "cavity") halved() cavity();
else if (part == "mould_outside") mould_outside();
else if (part == "mould_core") mould_core();
else if (part == "mould_base") mould_base();
else {
    color("LightSteelBlue") halved() body();
    color("SteelBlue") halved() base();
    color("Ivory") halved() paper();
}
