// Programs of the graphics processor (GLSL ES 3.00).
const sharedShader = `#version 300 es
precision highp float;
precision highp int;
uniform highp usampler2D facet_nodes;
uniform highp sampler2D node_table, normal_table, facet_table;
uniform mat4 view, projection;
ivec2 at(uint i) { return ivec2(int(i & 2047u), int(i >> 11)); }
vec4 node_at(uint i) { return texelFetch(node_table, at(i), 0); }
vec4 normal_at(uint i) { return texelFetch(normal_table, at(i), 0); }
`;

const faceVertexShader = `${sharedShader}
layout(location = 0) in uvec2 instance;
out vec3 place, normal, world;
out vec2 in_face;
out float node_value;
flat out float facet_value, part, features;
const int corner_of_vertex[6] = int[](0, 1, 2, 0, 2, 3);
const vec2 place_of_corner[4] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1));
void main() {
  uvec4 n = texelFetch(facet_nodes, at(instance.x), 0);
  vec4 facet = texelFetch(facet_table, at(instance.x), 0);
  vec4 p[4] = vec4[](node_at(n[0]), node_at(n[1]), node_at(n[2]), node_at(n[3]));
  vec3 flat_normal = cross(p[2].xyz - p[0].xyz, p[3].xyz - p[1].xyz);
  flat_normal /= max(length(flat_normal), 1e-30);
  int form = int(instance.y), corner = corner_of_vertex[gl_VertexID], own = corner;
  float side = form == 1 ? 1.0 : form == 2 ? -1.0 : 0.0;
  if (form == 2) own = (4 - corner) % 4;  // seen from behind, the other way round
  if (form > 2) {
    own = (form - 3 + (corner == 1 || corner == 2 ? 1 : 0)) % 4;
    side = corner < 2 ? -1.0 : 1.0;
  }
  vec4 at_node = normal_at(n[own]);
  float cosine = dot(at_node.xyz, flat_normal);
  vec3 outward = cosine > 0.05 ? at_node.xyz : flat_normal;  // of nodes, so that shells that meet stay together
  world = p[own].xyz + side * p[own].w * outward;
  vec3 shown = cosine > 0.8 ? at_node.xyz : flat_normal;
  if (form == 2) shown = -shown;
  if (form > 2) shown = cross(p[form - 2 & 3].xyz - p[form - 3].xyz, flat_normal);
  normal = mat3(view) * shown;
  place = (view * vec4(world, 1)).xyz;
  in_face = place_of_corner[form > 2 ? corner : own];
  features = form > 2 ? 5.0 : facet.y;
  node_value = at_node.w;
  facet_value = facet.x;
  part = facet.w;
  gl_Position = projection * vec4(place, 1);
}`;

const beamVertexShader = `${sharedShader}
layout(location = 0) in uint instance;
layout(location = 1) in vec3 offset;         // end, then in the section
layout(location = 2) in vec3 offset_normal;  // along the beam, then in the section
uniform vec3 orientation;
uniform bool by_radius;
out vec3 place, normal, world;
out vec2 in_face;
out float node_value;
flat out float facet_value, part, features;
void main() {
  uvec4 n = texelFetch(facet_nodes, at(instance), 0);
  vec4 facet = texelFetch(facet_table, at(instance), 0);
  vec3 a = node_at(n[0]).xyz, b = node_at(n[1]).xyz;
  vec3 x = (b - a) / max(length(b - a), 1e-30);
  vec3 wanted = length(cross(orientation, x)) > 1e-3 ? orientation : abs(x.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0);
  vec3 y = normalize(cross(wanted, x)), z = cross(x, y);
  vec2 in_section = offset.yz * (by_radius ? facet.z : 1.0);
  world = mix(a, b, offset.x) + y * in_section.x + z * in_section.y;
  normal = mat3(view) * (x * offset_normal.x + y * offset_normal.y + z * offset_normal.z);
  place = (view * vec4(world, 1)).xyz;
  in_face = vec2(0.5);
  features = 0.0;
  node_value = normal_at(offset.x < 0.5 ? n[0] : n[1]).w;
  facet_value = facet.x;
  part = facet.w;
  gl_Position = projection * vec4(place, 1);
}`;

const sphereVertexShader = `${sharedShader}
layout(location = 0) in uvec2 instance;
uniform float least_radius;
out vec3 place;
flat out vec3 centre;
flat out float radius, facet_value, part, node_value;
void main() {
  uint n = texelFetch(facet_nodes, at(instance.x), 0)[instance.y];
  vec4 facet = texelFetch(facet_table, at(instance.x), 0);
  centre = (view * vec4(node_at(n).xyz, 1)).xyz;
  radius = max(facet.z, least_radius);
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  // Somewhat larger, and nearer by the radius: near the border of the view a sphere is seen as an ellipse.
  place = centre + vec3(corner * radius * 1.25, radius);
  facet_value = facet.x;
  node_value = normal_at(n).w;
  part = facet.w;
  gl_Position = projection * vec4(place, 1);
}`;

const lightShader = `
uniform sampler2D colour_map, part_colours;
uniform int colouring;  // 0 by part, 1 by facets, 2 by nodes
uniform vec2 range;
uniform vec4 cut;  // what is kept has dot(cut.xyz, place) <= cut.w
vec3 base_colour(float facet, float node, float part_number) {
  vec3 own = texelFetch(part_colours, ivec2(int(part_number) & 1023, int(part_number) >> 10), 0).rgb;
  if (colouring == 0) return own;
  float value = colouring == 2 ? node : facet;
  if (facet < -1e38 || value < -1e38) return mix(own, vec3(0.74), 0.85);
  return texture(colour_map, vec2(clamp((value - range.x) / max(range.y - range.x, 1e-37), 0.002, 0.998), 0.5)).rgb;
}
vec3 lit(vec3 colour, vec3 n, vec3 towards_eye) {
  vec3 key = normalize(vec3(0.35, 0.65, 0.75)), fill = normalize(vec3(-0.7, -0.1, 0.5));
  float diffuse = 0.56 * max(dot(n, key), 0.0) + 0.16 * max(dot(n, fill), 0.0);
  float shine = pow(max(dot(n, normalize(key + towards_eye)), 0.0), 38.0);
  return colour * (0.5 + 0.07 * n.y + diffuse) + 0.09 * shine;
}
`;

const faceFragmentShader = `#version 300 es
precision highp float;
precision highp int;
in vec3 place, normal, world;
in vec2 in_face;
in float node_value;
flat in float facet_value, part, features;
uniform bool mesh_lines, feature_lines;
out vec4 colour;
${lightShader}
void main() {
  if (dot(cut.xyz, world) > cut.w) discard;
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) n = -n;
  vec3 shown = base_colour(facet_value, node_value, part);
  if (!gl_FrontFacing) shown *= 0.86;
  shown = lit(shown, n, normalize(-place));
  vec4 from_edge = vec4(in_face.y, 1.0 - in_face.x, 1.0 - in_face.y, in_face.x);
  vec4 pixel = max(fwidth(from_edge), 1e-6);
  vec4 distance_in_pixels = from_edge / pixel;
  if (mesh_lines) {
    float nearest = min(min(distance_in_pixels.x, distance_in_pixels.y), min(distance_in_pixels.z, distance_in_pixels.w));
    float fine = 1.0 - smoothstep(0.08, 0.3, max(max(pixel.x, pixel.y), max(pixel.z, pixel.w)));
    shown *= 1.0 - 0.3 * fine * (1.0 - smoothstep(0.2, 1.0, nearest));
  }
  if (feature_lines) {
    int mask = int(features + 0.5);
    float ink = 0.0;  // less where a face is but a few pixels wide
    for (int e = 0; e < 4; ++e) {
      if ((mask >> e & 1) == 0) continue;
      float line = 1.0 - smoothstep(0.5, 1.5, distance_in_pixels[e]);
      ink = max(ink, line * (1.0 - 0.75 * smoothstep(0.1, 0.35, pixel[e])));
    }
    shown *= 1.0 - 0.62 * ink;
  }
  colour = vec4(shown, 1);
}`;

const sphereFragmentShader = `#version 300 es
precision highp float;
precision highp int;
in vec3 place;
flat in vec3 centre;
flat in float radius, facet_value, part, node_value;
uniform mat4 view, projection;
out vec4 colour;
${lightShader}
void main() {
  vec3 ray = normalize(place);
  float middle = dot(ray, centre), reach = middle * middle - dot(centre, centre) + radius * radius;
  if (reach < 0.0) discard;
  vec3 seen = ray * (middle - sqrt(reach));
  vec3 world = transpose(mat3(view)) * (seen - view[3].xyz);
  if (dot(cut.xyz, world) > cut.w) discard;
  vec4 clip = projection * vec4(seen, 1);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  colour = vec4(lit(base_colour(facet_value, node_value, part), (seen - centre) / radius, -ray), 1);
}`;
