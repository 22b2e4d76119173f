#include "tools/maps/dxf_document.hpp"

#include <utility>

#include "slam/core/pose.hpp"
#include "tools/maps/dxf_frame.hpp"
#include "tools/maps/dxf_groups.hpp"

namespace planum {

using dxf::append, dxf::append_handle, dxf::append_point, dxf::append_point_in_space;
using Eigen::Vector2d;

DxfDocument::DxfDocument(std::vector<DxfLayer> layers)
    : layers_(std::move(layers)),
      next_handle_(dxf::first_layer + 1 + static_cast<unsigned>(layers_.size())) {}

void DxfDocument::begin_entity(const char* type, const std::string& layer, bool is_dashed) {
  append(entities_, 0, type);
  append_handle(entities_, 5, next_handle_++);
  append_handle(entities_, 330, dxf::model_space);
  append(entities_, 100, "AcDbEntity");
  append(entities_, 8, layer);
  if (is_dashed) append(entities_, 6, "DASHED");
}

void DxfDocument::add_line(const std::string& layer, const Vector2d& from, const Vector2d& to,
                           bool is_dashed) {
  begin_entity("LINE", layer, is_dashed);
  append(entities_, 100, "AcDbLine");
  append_point_in_space(entities_, from, 10);
  append_point_in_space(entities_, to, 11);
}

void DxfDocument::add_closed_polyline(const std::string& layer,
                                      const std::vector<Vector2d>& corners) {
  begin_entity("LWPOLYLINE", layer, false);
  append(entities_, 100, "AcDbPolyline");
  append(entities_, 90, static_cast<int>(corners.size()));
  append(entities_, 70, 1);
  for (const Vector2d& p : corners) append_point(entities_, p);
}

void DxfDocument::add_arc(const std::string& layer, const Vector2d& centre, double radius,
                          double from, double to, bool is_dashed) {
  begin_entity("ARC", layer, is_dashed);
  append(entities_, 100, "AcDbCircle");
  append_point_in_space(entities_, centre);
  append(entities_, 40, radius);
  append(entities_, 100, "AcDbArc");
  append(entities_, 50, degrees(from));
  append(entities_, 51, degrees(to));
}

void DxfDocument::add_text(const std::string& layer, const Vector2d& place, double height,
                           double turn, const std::string& words) {
  begin_entity("TEXT", layer, false);
  append(entities_, 100, "AcDbText");
  append_point_in_space(entities_, place, 10);
  append(entities_, 40, height);
  append(entities_, 1, dxf::in_ascii(words));
  append(entities_, 50, degrees(turn));
  append(entities_, 72, 1);  // centred
  append_point_in_space(entities_, place, 11);
  append(entities_, 100, "AcDbText");
}

std::string DxfDocument::written(const Eigen::AlignedBox2d& extent,
                                 const std::string& comment) const {
  return dxf::before_entities(layers_, extent, comment, next_handle_) + entities_ +
         dxf::after_entities();
}

}  // namespace planum
