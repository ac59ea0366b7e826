//! Every tolerance of the library, each relative to a stated length, with its reason.
//! Stages work in the canonical frame, where the domain's bounding-box diagonal is 1
//! ([`crate::domain::Frame`]), so "relative to the diagonal" is the plain number there.

/// Largest gap between the end of a segment and the start of the next that is closed silently,
/// relative to the domain's diagonal. Files written with six digits need 1e-6; 1e-4 takes
/// the worst of HOHQMesh's examples.
pub const JOIN: f64 = 1e-4;

/// Gap between a path's last point and its first below which there is no closing line, relative to the size of the
/// path: coordinates in single precision, and sums of relative ones, miss the first point by about as much. A
/// line as short as that would be a segment with two corners, which the mesh has to keep apart.
pub const CLOSED_PATH: f64 = 2e-7;

/// Cosine of the turn (165°) from which a closing line no longer than [`JOIN`] runs back over the path: rounded
/// coordinates went past the start. A blunt tip's closing line turns by about 90°.
pub const TURNED_BACK: f64 = 0.966;

/// Least change of direction, in radians, that makes a boundary point a mesh vertex for good
/// (a polynomial edge across it would converge algebraically only).
pub const CORNER_TURN: f64 = 1e-3;

/// Least change of direction, in radians, at which a boundary point launches separatrices of its
/// own: below, the lines that pass by are aligned well enough.
pub const PORT_TURN: f64 = 0.05;

/// Shortest boundary edge that subdivision makes, relative to the domain's diagonal: the exact
/// curves' own rounding (1e-16) is still a millionth of it.
pub const SHORTEST_EDGE: f64 = 1e-10;

/// Boundary tolerance, in the canonical frame, below which none is looked for: edges would be measured against the
/// rounding of their own coordinates, about 1e-16.
pub const LEAST_TOLERANCE: f64 = 1e-15;

/// Largest share of a closed chain that one edge may cover: a loop has at least three edges.
pub const LONGEST_LOOP_SHARE: f64 = 1.0 / 3.0;

/// Share of the boundary tolerance that placement aims at, so that vertices may still slide.
pub const PLACEMENT_MARGIN: f64 = 0.9;
/// Usual base edge, relative to the domain's diagonal. About 1/28 resolves the field of simple shapes;
/// the odd digits keep sides of simple ratio (1/2, 1/√2) away from a tie.
pub const BASE_EDGE_DIAGONAL: f64 = 1.0 / 27.37;

/// Usual base edge, relative to the square root of the domain's area: long thin domains need
/// more triangles than their diagonal tells.
pub const BASE_EDGE_AREA: f64 = 1.0 / 16.23;

/// Most that the boundary may turn along one chord of the base mesh, in radians. Coarser than
/// 0.3 loses the field's rotation around airfoil noses.
pub const CHORD_TURN: f64 = 0.21;

/// Most that the two chords at a corner may turn, as a share of the corner's angle: the polygon's
/// corner must stay like the boundary's.
pub const CORNER_CHORD_TURN: f64 = 0.31;

/// Largest ratio of the lengths of neighbouring chords.
pub const CHORD_RATIO: f64 = 2.6;

/// Height of the arc over its chord, relative to the gap to the boundary across, above which
/// the chord is halved: below, the polygon's gap is the boundary's within a fifth.
pub const CHORD_SAGITTA: f64 = 0.11;

/// Border vertices of the base mesh lie on a grid of this spacing, relative to the diagonal, so that
/// rounding noise in the input leaves the base mesh the same to the bit. 2^-26.
pub const SNAP_GRID: f64 = 1.0 / 67_108_864.0;

/// Chord length, relative to the diagonal, below which border vertices are not moved to the grid:
/// there the grid would turn chords by more than 1e-3 rad.
pub const SNAP_LEAST_CHORD: f64 = 1e-5;

/// Least angle asked of the base triangles, in degrees; Delaunay refinement ends for sure
/// below about 20.7° and in practice up to 30°.
pub const BASE_ANGLE: f64 = 26.0;

/// Corner angle in radians (45°) below which the field gets no quad there: the tip's region
/// is a triangle, which the layout repairs by the paper's rule.
pub const TIP_ANGLE: f64 = std::f64::consts::FRAC_PI_4;

/// Width of a tie in Table 1, in quarter turns: at exactly 45°, 135°, 225° and 315° rounding noise
/// must not choose the number of quads.
pub const CORNER_TIE: f64 = 1e-6;

/// Distance from a tie of Table 1, in radians (15°), within which a corner may take up a singularity beside it, ...
pub const CORNER_DOUBT: f64 = std::f64::consts::PI / 12.0;

/// ... if the quads' angles there are between 60° and 120° then: as good as those at a singular point.
pub const ABSORBING_ANGLES: [f64; 2] = [std::f64::consts::FRAC_PI_3, 2.0 * std::f64::consts::FRAC_PI_3];

/// Diffusion time of one diffuse-and-renormalise step, relative to the square of the domain's local
/// thickness. Five times less leaves pairs of opposite singularities between tubes (118 among 100 tubes), some
/// times more only brings back the harmonic field, with its pairs.
pub const DIFFUSION_TIME: f64 = 0.06;

/// Number of diffuse-and-renormalise steps: 5 leave 29 pairs among 100 tubes, 10 leave 2.
pub const DIFFUSION_STEPS: usize = 10;

/// Farthest that the sum of the turns around a base triangle may be from whole quarter turns, in radians.
/// Rounding leaves about 1e-14.
pub const WINDING_ROUNDING: f64 = 1e-6;

/// Least barycentric coordinate of a singular point in its triangle, so that its ports stay apart.
pub const SINGULAR_BARYCENTRIC: f64 = 0.1;

/// Least distance of a port from the triangle's corners, as a share of the edge.
pub const PORT_SHARE: f64 = 1e-3;

/// Distance between singularities of equal sign, in local edge lengths, below which the base mesh is
/// refined between them.
pub const LIKE_SIGN_EDGES: f64 = 2.0;

/// Most that a boundary edge should turn, in radians, while it is not yet coarsened: seven edges for a circle. Layouts of
/// sizes 1.4 times as large are hardly faster and need a second start more often.
pub const EDGE_TURN: f64 = 0.9;
/// Most that the cross may turn along a base edge at the border, in radians, where no singularity
/// is: beyond, the edge's turn is close to the tie at 45°.
pub const BORDER_EDGE_TURN: f64 = 0.6;

/// Base edge, relative to the usual one, below which no check asks for refinement: singularities
/// of a multiple zero come closer with every refinement.
pub const LEAST_REFINEMENT: f64 = 1.0 / 12.0;

/// Corner angle in radians (60°) below which Delaunay refinement cannot enforce its angle bound: base
/// triangles at such tips are left as they are.
pub const SHARP_TIP: f64 = std::f64::consts::FRAC_PI_3;
/// Largest difference between the layout regions' areas and the domain's, relative to the domain's area:
/// traces and base mesh are polygons, so areas agree only roughly; a region counted twice or missing
/// differs by more.
pub const LAYOUT_AREA: f64 = 0.05;

/// Largest distance of a boundary vertex from the point of its place, relative to the domain's
/// diagonal: both are evaluations of the same table, or of the exact curve beside it.
pub const PLACE_DISTANCE: f64 = 1e-9;

/// Largest difference of arc lengths that are the same place, relative to the domain's diagonal.
pub const SPAN_GAP: f64 = 1e-12;

/// Corner angles (32° to 58°) across which the cross turns by 32° or more: near 45° both senses of that turn
/// cost the same.
pub const TIP_DOUBT: [f64; 2] = [0.558, 1.012];

/// How far from such a corner the field is held on the corner's own solution, relative to the shorter side.
/// The singular point of a corner just above 45° settles there, so it sets the tip's element size.
pub const TIP_SHARE: f64 = 0.25;

/// Most that a side may turn within that distance, in radians.
pub const TIP_TURN: f64 = 0.1;
/// Gap at a joint, relative to the domain's diagonal, that is mere rounding: which of the two ends
/// moves is then decided in the normalised orientation, so that loops given backwards agree.
pub const JOIN_ROUNDING: f64 = 1e-12;

/// Distance, relative to the domain's diagonal, below which boundary curves touch. Gaps of 1e-5
/// occur in real outlines and are meshed; below this no element has a sensible shape.
pub const TOUCH: f64 = 1e-9;

/// Size, relative to the domain's diagonal, of a segment or loop without extent.
pub const NO_EXTENT: f64 = 1e-9;

/// Interior angle, in radians, below which a corner is a cusp and refused (0.1°): the scaled Jacobian
/// there cannot exceed its sine.
pub const CUSP_ANGLE: f64 = 1.7e-3;

/// A reversal of direction that is exact up to this, in radians: the sign of the turn then says
/// nothing about the side.
pub const REVERSAL: f64 = 1e-7;

/// Difference of canonical lengths that is rounding when poses are compared.
pub const POSE_TIE: f64 = 1e-9;

/// Largest distance of the boundary tables' interpolant from a smooth curve, relative to the canonical
/// diagonal: far below any tolerance a caller can ask for in double precision.
pub const TABLE_ERROR: f64 = 1e-11;

/// Table intervals shorter than this, relative to the canonical diagonal, are not divided further: a
/// singular parametrisation ends somewhere.
pub const TABLE_SHORTEST: f64 = 1e-9;

/// Distance from the tip of a cusp, relative to the smaller of its two segments, within which its branches may
/// come closer than the touching distance: with any visible difference of curvature they are further apart beyond.
pub const CUSP_REACH: f64 = 1e-2;
/// Distance along the tangent, relative to the domain's diagonal, at which a point of the exact curve
/// is at the wanted arc length: a few roundings of a coordinate.
pub const EXACT_FOOT: f64 = 1e-15;

/// Arc length, relative to the canonical diagonal, to which a curve's parameter is found for a given arc length.
pub const ARC_LENGTH_MATCH: f64 = 1e-13;

/// Relative difference of area and of its moments below which two loops that meet are the same.
pub const SAME_MOMENTS: f64 = 1e-6;

/// Grid on which the optimiser's positions and shapes stay while decisions hang on them, relative to the local
/// edge length: one step makes of the input's rounding errors (1e-16, far from the caller's origin 1e-13) a
/// hundred times as much, the next steps would go on; and a thousandth of an edge decides nothing. 2^-10.
pub const DECISION_GRID: f64 = 1.0 / 1024.0;

/// The same while a whole mesh is optimised: thousands of positions in hundreds of steps, each of which may fall on
/// the other side. 2^-8.
pub const WHOLE_GRID: f64 = 1.0 / 256.0;

/// The same for the mesh that is kept. 2^-18.
pub const FINAL_GRID: f64 = 1.0 / 262_144.0;

/// Grid on which the layout's vertices start, relative to the shortest edge there: coarse against what the
/// streamlines make of the input's rounding errors (1e-10). 2^-10.
pub const START_GRID: f64 = 1.0 / 1024.0;

/// A factor on lengths whose next power of two is taken as a grid: simple ratios to the diagonal, which are common,
/// would stand at the jump from one power to the next, where rounding decides.
pub const OFF_POWERS: f64 = 1.37;

/// Sizes and errors that differ by less than this share are equally large when changes of a mesh are put
/// in order: in symmetric domains many are equal up to rounding.
pub const ORDER_TIE: f64 = 1e-6;

/// Arc length, relative to the canonical diagonal, within which a boundary vertex that the caller gives is the
/// junction there: parameters come with roundings, and no chain is so short.
pub const JUNCTION_MATCH: f64 = 1e-9;

/// Most that a border vertex of the caller's base mesh may be off its place on the curve, relative to its
/// shorter border edge: half way along a chord that turns by 0.8 rad, where refiners put vertices.
pub const GIVEN_OFF_CURVE: f64 = 0.2;

/// Farthest that a straight chain's table may be off the segment between its ends, relative to the chain's length:
/// rounding, also far from the caller's origin. Edges on it count as free of any boundary error.
pub const STRAIGHT_CHAIN: f64 = 1e-11;
/// Distance of an edge's nodes from their places on the straight line between its ends, relative to the
/// largest coordinate of the ends, that is rounding: files then call the side straight. 16 roundings.
pub const STRAIGHT_SIDE: f64 = 16.0 * f64::EPSILON;

/// Distance, relative to the canonical diagonal, within which a boundary lies on its mirrored or turned image if it
/// is symmetric: ten times what the tables' interpolant may be off; drawings that are not exact differ by 1e-6.
pub const SYMMETRY: f64 = 1e-10;

/// The same for a first look at a mirror or rotation that is then fitted: extremes of a distance are found to the
/// square root of rounding.
pub const SYMMETRY_ROUGH: f64 = 1e-7;

/// Difference of two corners' angles, in radians, up to which they may be images of each other. Derivatives of
/// callbacks by differences have it.
pub const SYMMETRY_ANGLE: f64 = 1e-6;

/// Distance, relative to the domain's diagonal, by which a boundary node may be off its mirror image: less is
/// rounding, and the exact point stays.
pub const SYMMETRY_ROUNDING: f64 = 1e-14;

/// Root mean square error of waves of amplitude 1 below which no element is divided for them: no solver asks for
/// less, and the elements' places are not much more exact.
pub const LEAST_WAVE_ERROR: f64 = 1e-10;

/// Distance along a chain up to which a vertex counts as lying on a break, where it was put to rounding: the shortest
/// edges are a thousand times as long.
pub const ON_BREAK: f64 = 1e-10;

/// Share by which two divisions may differ in worth and still be made together: what is symmetric only to rounding,
/// or to what smoothing leaves, must be divided alike.
pub const EQUAL_WORTH: f64 = 1e-3;

/// Sine of the angle of two fixed straight sides of an element up to which its corner counts as flat: the element has no
/// better scaled Jacobian unless one of them bends.
pub const FLAT_CORNER: f64 = 0.05;

/// Least det J, divided by the element's area, that counts as positive: less is what rounding makes of a flat corner.
pub const LEAST_JACOBIAN: f64 = 1e-12;
