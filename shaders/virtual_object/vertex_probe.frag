// SPDX-License-Identifier: Apache-2.0
// See vertex_probe.vert.

flat in vec4 v_vertex;

layout(location = 0) out vec4 o_vertex;

void main() { o_vertex = v_vertex; }
