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

const char* const kVertex = R"(#version 120
varying vec3 place;   // in the camera's frame
varying vec3 normal;
void main() {
  place = vec3(gl_ModelViewMatrix * gl_Vertex);
  normal = gl_NormalMatrix * gl_Normal;
  gl_FrontColor = gl_Color;
  gl_BackColor = gl_Color;
  gl_Position = ftransform();
}
)";

// Coin sends the diffuse colour as the colour of a corner, the rest as a material.
const char* const kFragment = R"(#version 120
uniform sampler2DShadow shadows;
uniform mat4 to_map;    // from the camera's frame to the map
uniform float offset;   // distance from the surface at which the map is read [m]
uniform float bias;     // depth that a caster may be above a point without a shadow on it
uniform float texel;    // edge of a texel, the edge of the map being 1
varying vec3 place;
varying vec3 normal;

float sun_at(vec3 p) {
  vec3 at = vec3(to_map * vec4(p, 1.0)) + vec3(0.0, 0.0, bias);
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      lit += shadow2D(shadows, at + vec3(float(x) * texel, float(y) * texel, 0.0)).r;
  return lit / 9.0;
}

void main() {
  // Plates are lit from both sides.
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  vec3 color = gl_FrontMaterial.emission.rgb +
               gl_FrontMaterial.ambient.rgb * gl_LightModel.ambient.rgb;
  for (int i = 0; i < 3; ++i) {
    vec3 to_light = normalize(gl_LightSource[i].position.xyz);
    float facing = dot(n, to_light);
    color += gl_FrontMaterial.ambient.rgb * gl_LightSource[i].ambient.rgb;
    if (facing <= 0.0) continue;
    float shine = pow(max(dot(n, normalize(to_light + vec3(0.0, 0.0, 1.0))), 0.0),
                      max(gl_FrontMaterial.shininess, 1e-3));
    vec3 light = gl_Color.rgb * gl_LightSource[i].diffuse.rgb * facing +
                 gl_FrontMaterial.specular.rgb * gl_LightSource[i].specular.rgb * shine;
    color += i == 0 ? light * sun_at(place + offset * n) : light;
  }
  float clear = clamp((gl_Fog.end + place.z) * gl_Fog.scale, 0.0, 1.0);
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
  offset_ = glGetUniformLocation(program_, "offset");
  bias_ = glGetUniformLocation(program_, "bias");
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
  // Farther than a texel that is seen at a slant, so that a face shadows neither itself nor the
  // next one around its edge.
  glUniform1f(offset_, 2.0f * map.texel());
  glUniform1f(bias_, 3.0f * map.texel() * map.plane_r().head<3>().norm());
  glUniform1f(texel_, 1.0f / ShadowMap::kSize);
}

void BodyShader::stop() const { glUseProgram(0); }

}  // namespace navvy::render
