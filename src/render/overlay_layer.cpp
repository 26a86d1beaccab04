// SPDX-License-Identifier: Apache-2.0
#include "render/overlay_layer.h"

#include <Inventor/SbVec3f.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCamera.h>
#include <Inventor/nodes/SoDepthBuffer.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoLineSet.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoText2.h>
#include <Inventor/nodes/SoTranslation.h>
#include <Inventor/nodes/SoVertexProperty.h>

namespace navvy::render {
namespace {

// Place of the caption from the left and the upper edge of the picture [pixels].
constexpr double kCaptionX = 12, kCaptionY = 22;

SbVec3f to_coin(const Vec3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

SoSeparator* group() {
  auto* out = new SoSeparator;
  // The content changes with each picture.
  out->renderCaching = SoSeparator::OFF;
  out->renderCulling = SoSeparator::OFF;
  return out;
}

}  // namespace

OverlayLayer::OverlayLayer(SoCamera* camera) : root_(group()), content_(group()) {
  root_->ref();
  root_->addChild(camera);
  auto* plain = new SoLightModel;
  plain->model = SoLightModel::BASE_COLOR;
  root_->addChild(plain);
  root_->addChild(content_);
}

OverlayLayer::~OverlayLayer() { root_->unref(); }

void OverlayLayer::set(const scene::FrameOverlay& overlay, const View& view) {
  content_->removeAllChildren();
  for (const scene::FrameLine& line : overlay.lines) add(line);
  for (const scene::FrameLabel& label : overlay.labels)
    add(label.text, label.p_W, label.color, view);
  if (overlay.caption.empty()) return;
  // A point one metre in front of the camera.
  const Vec3 p_C((2 * kCaptionX / view.width - 1) * view.tan_x,
                 (1 - 2 * kCaptionY / view.height) * view.tan_y, -1);
  add(overlay.caption, view.eye.cast<double>() + view.rotation * p_C, {1, 1, 1, 1}, view);
}

void OverlayLayer::add(const scene::FrameLine& line) {
  if (line.points.size() < 2) return;
  SoSeparator* out = group();
  auto* depth = new SoDepthBuffer;
  depth->test = line.hidden;
  depth->write = false;
  out->addChild(depth);
  auto* style = new SoDrawStyle;
  style->lineWidth = static_cast<float>(line.width);
  out->addChild(style);
  auto* color = new SoBaseColor;
  color->rgb.setValue(line.color.r, line.color.g, line.color.b);
  out->addChild(color);
  auto* points = new SoVertexProperty;
  for (std::size_t i = 0; i < line.points.size(); ++i)
    points->vertex.set1Value(static_cast<int>(i), to_coin(line.points[i]));
  auto* set = new SoLineSet;
  set->vertexProperty = points;
  out->addChild(set);
  content_->addChild(out);
}

void OverlayLayer::add(const std::string& text, const Vec3& p_W, const scene::Color& color,
                       const View& view) {
  const Vec3 eye = view.eye.cast<double>();
  const double distance = -(view.rotation.transpose() * (p_W - eye)).z();
  // Coin would draw a text behind the camera at its mirrored place.
  if (distance < View::kNear) return;
  const Vec3 pixel =
      (distance / view.pixels_per_radian) * (view.rotation.col(0) - view.rotation.col(1));
  for (const bool shadow : {true, false}) {
    SoSeparator* out = group();
    auto* depth = new SoDepthBuffer;
    depth->test = false;
    depth->write = false;
    out->addChild(depth);
    auto* base = new SoBaseColor;
    const float light = shadow ? 0.0f : 1.0f;
    base->rgb.setValue(light * color.r, light * color.g, light * color.b);
    out->addChild(base);
    auto* place = new SoTranslation;
    place->translation = to_coin(shadow ? Vec3(p_W + pixel) : p_W);
    out->addChild(place);
    auto* letters = new SoText2;
    letters->string = text.c_str();
    out->addChild(letters);
    content_->addChild(out);
  }
}

}  // namespace navvy::render
