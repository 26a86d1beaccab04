// SPDX-License-Identifier: Apache-2.0
#include "render/body_shader.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <string>

#include "core/log.h"

namespace navvy::render {
namespace {

/// Texture unit of the shadow map; unit 0 belongs to Coin.
constexpr int kUnit = 3;

// Light is computed at corners, as OpenGL does by itself: for each of 10^5 pixels it would cost
// more than all else in a picture. Coin sends the diffuse colour as the colour of a corner, the
// rest as a material.
const char* const kVertex = R"(#version 120
uniform mat4 to_map;    // from the camera's frame to the map
uniform float texel;    // edge of a texel, in units of the map's depth
varying vec3 at;        // place in the map
varying float clear;    // share that haze leaves
// Light of a directional source on a side with normal n.
vec3 light(int i, vec3 n) {
  vec3 to_light = normalize(gl_LightSource[i].position.xyz);
  float facing = dot(n, to_light);
  if (facing <= 0.0) return vec3(0.0);
  float shine = pow(max(dot(n, normalize(to_light + vec3(0.0, 0.0, 1.0))), 0.0),
                    max(gl_FrontMaterial.shininess, 1e-3));
  return gl_Color.rgb * gl_LightSource[i].diffuse.rgb * facing +
         gl_FrontMaterial.specular.rgb * gl_LightSource[i].specular.rgb * shine;
}
vec4 without_sun(vec3 n) {
  vec3 ambient = gl_LightModel.ambient.rgb;
  for (int i = 0; i < 3; ++i) ambient += gl_LightSource[i].ambient.rgb;
  return vec4(gl_FrontMaterial.emission.rgb + gl_FrontMaterial.ambient.rgb * ambient + light(1, n) +
                  light(2, n),
              gl_Color.a);
}
void main() {
  vec4 place = gl_ModelViewMatrix * gl_Vertex;
  vec3 n = normalize(gl_NormalMatrix * gl_Normal);
  gl_FrontColor = without_sun(n);
  gl_BackColor = without_sun(-n);
  gl_FrontSecondaryColor = vec4(light(0, n), 1.0);
  gl_BackSecondaryColor = vec4(light(0, -n), 1.0);
  // A face shadows neither itself, the less the more it faces the sun, nor the next one around its
  // edge.
  float facing = abs(dot(n, normalize(gl_LightSource[0].position.xyz)));
  float slope = sqrt(max(1.0 - facing * facing, 0.0)) / max(facing, 0.2);
  at = vec3(to_map * place) + vec3(0.0, 0.0, texel * (3.0 + 1.5 * slope));
  clear = clamp((gl_Fog.end + place.z) * gl_Fog.scale, 0.0, 1.0);
  gl_Position = ftransform();
}
)";

const char* const kFragment = R"(#version 120
uniform sampler2DShadow shadows;
varying vec3 at;
varying float clear;
void main() {
  vec3 color = gl_Color.rgb + gl_SecondaryColor.rgb * shadow2D(shadows, at).r;
  gl_FragColor = vec4(mix(gl_Fog.color.rgb, min(color, vec3(1.0)), clear), gl_Color.a);
}
)";

/// Returns the name of a compiled part of a program; 0 if it does not compile.
GLuint part(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  std::string why(1024, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(why.size()), &length, why.data());
  why.resize(static_cast<std::size_t>(length));
  log(LogLevel::kWarning, "pictures have no shadows on machines: " + why);
  glDeleteShader(shader);
  return 0;
}

}  // namespace

void BodyShader::compile() {
  compiled_ = true;
  const GLuint vertex = part(GL_VERTEX_SHADER, kVertex);
  const GLuint fragment = vertex != 0 ? part(GL_FRAGMENT_SHADER, kFragment) : 0;
  if (fragment == 0) return;
  program_ = glCreateProgram();
  glAttachShader(program_, vertex);
  glAttachShader(program_, fragment);
  glLinkProgram(program_);
  // They stay as long as the program.
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  to_map_ = glGetUniformLocation(program_, "to_map");
  shadows_ = glGetUniformLocation(program_, "shadows");
  texel_ = glGetUniformLocation(program_, "texel");
}

void BodyShader::use(const ShadowMap& map, const Eigen::Matrix4f& X_CW) {
  if (!compiled_) compile();
  if (program_ == 0) return;
  Texture& texture = textures_[&map];
  glActiveTexture(GL_TEXTURE0 + kUnit);
  if (texture.name == 0) glGenTextures(1, &texture.name);
  glBindTexture(GL_TEXTURE_2D, texture.name);
  if (texture.version != map.version()) {
    texture.version = map.version();
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, ShadowMap::kSize, ShadowMap::kSize, 0,
                 GL_DEPTH_COMPONENT, GL_FLOAT, map.depths().data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    // A point is lit if it is at least as near to the sun as the nearest caster.
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_R_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
  }
  glActiveTexture(GL_TEXTURE0);
  Eigen::Matrix4f to_map = Eigen::Matrix4f::Identity();
  to_map.row(0) = map.plane_s();
  to_map.row(1) = map.plane_t();
  to_map.row(2) = map.plane_r();
  to_map *= X_CW.inverse();
  glUseProgram(program_);
  glUniformMatrix4fv(to_map_, 1, GL_FALSE, to_map.data());
  glUniform1i(shadows_, kUnit);
  glUniform1f(texel_, map.texel() * map.plane_r().head<3>().norm());
  // Plates are lit from both sides.
  glEnable(GL_VERTEX_PROGRAM_TWO_SIDE);
}

void BodyShader::stop() const {
  glUseProgram(0);
  glDisable(GL_VERTEX_PROGRAM_TWO_SIDE);
}

}  // namespace navvy::render
