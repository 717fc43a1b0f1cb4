// SPDX-License-Identifier: Apache-2.0
// Pixels that no reference has seen, when they are to be marked: magenta, and the sky for what is seen there.

const vec3 kExposureColor = vec3(1.0f, 0.0f, 1.0f);
