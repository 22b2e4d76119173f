#include "tools/maps/dxf_frame.hpp"

#include <cmath>

#include "tools/maps/dxf_groups.hpp"

namespace planum::dxf {
namespace {

using Eigen::Vector2d;

// Handles of what every file of AutoCAD 2000 must have; layers and entities follow.
constexpr unsigned root_dictionary = 0x0C, group_dictionary = 0x0D;
constexpr unsigned viewport_table = 0x08, linetype_table = 0x05, layer_table = 0x02,
                   style_table = 0x03, view_table = 0x06, ucs_table = 0x07,
                   application_table = 0x09, dimension_style_table = 0x0A,
                   block_record_table = 0x01;
constexpr unsigned paper_space = 0x1B;

void begin_table(std::string& text, const char* name, unsigned handle, std::size_t count) {
  append(text, 0, "TABLE");
  append(text, 2, name);
  append_handle(text, 5, handle);
  append(text, 330, "0");
  append(text, 100, "AcDbSymbolTable");
  append(text, 70, static_cast<int>(count));
}

void begin_record(std::string& text, const char* type, const char* subclass, unsigned handle,
                  unsigned owner, const std::string& name) {
  append(text, 0, type);
  append_handle(text, std::string(type) == "DIMSTYLE" ? 105 : 5, handle);
  append_handle(text, 330, owner);
  append(text, 100, "AcDbSymbolTableRecord");
  append(text, 100, subclass);
  append(text, 2, name);
}

void append_linetype(std::string& text, unsigned handle, const char* name,
                     const std::vector<double>& dashes) {
  begin_record(text, "LTYPE", "AcDbLinetypeTableRecord", handle, linetype_table, name);
  append(text, 70, 0);
  append(text, 3, "");
  append(text, 72, 65);
  append(text, 73, static_cast<int>(dashes.size()));
  double length = 0;
  for (const double dash : dashes) length += std::abs(dash);
  append(text, 40, length);
  for (const double dash : dashes) {
    append(text, 49, dash);
    append(text, 74, 0);
  }
}

std::string header(const Eigen::AlignedBox2d& extent, const std::string& comment, unsigned seed) {
  std::string text;
  append(text, 999, in_ascii(comment));
  append(text, 0, "SECTION");
  append(text, 2, "HEADER");
  append(text, 9, "$ACADVER");
  append(text, 1, "AC1015");
  append(text, 9, "$DWGCODEPAGE");
  append(text, 3, "ANSI_1252");
  append(text, 9, "$INSUNITS");  // metres
  append(text, 70, 6);
  append(text, 9, "$MEASUREMENT");  // metric
  append(text, 70, 1);
  append(text, 9, "$LUNITS");  // decimal
  append(text, 70, 2);
  append(text, 9, "$EXTMIN");
  append_point_in_space(text, extent.min());
  append(text, 9, "$EXTMAX");
  append_point_in_space(text, extent.max());
  append(text, 9, "$HANDSEED");
  append_handle(text, 5, seed);
  append(text, 0, "ENDSEC");
  return text;
}

std::string viewport(const Eigen::AlignedBox2d& extent) {
  std::string text;
  begin_table(text, "VPORT", viewport_table, 1);
  begin_record(text, "VPORT", "AcDbViewportTableRecord", 0x29, viewport_table, "*Active");
  const Vector2d size = extent.sizes();
  append(text, 70, 0);
  append_point(text, Vector2d(0, 0), 10);
  append_point(text, Vector2d(1, 1), 11);
  append_point(text, extent.center(), 12);
  append_point_in_space(text, Vector2d(0, 0), 17);
  append(text, 16, 0.0);
  append(text, 26, 0.0);
  append(text, 36, 1.0);
  append(text, 40, size.y());
  append(text, 41, size.y() > 0 ? size.x() / size.y() : 1.0);
  append(text, 0, "ENDTAB");
  return text;
}

std::string linetypes() {
  std::string text;
  begin_table(text, "LTYPE", linetype_table, 4);
  append_linetype(text, 0x14, "ByBlock", {});
  append_linetype(text, 0x15, "ByLayer", {});
  append_linetype(text, 0x16, "Continuous", {});
  append_linetype(text, 0x17, "DASHED", {0.08, -0.05});
  append(text, 0, "ENDTAB");
  return text;
}

std::string layer_list(const std::vector<DxfLayer>& layers) {
  std::string text;
  begin_table(text, "LAYER", layer_table, layers.size() + 1);
  unsigned handle = first_layer;
  const auto add = [&](const DxfLayer& layer) {
    begin_record(text, "LAYER", "AcDbLayerTableRecord", handle++, layer_table, layer.name);
    append(text, 70, 0);
    append(text, 62, layer.colour);
    append(text, 6, "Continuous");
  };
  add({"0", 7});
  for (const DxfLayer& layer : layers) add(layer);
  append(text, 0, "ENDTAB");
  return text;
}

std::string text_styles() {
  std::string text;
  begin_table(text, "STYLE", style_table, 1);
  begin_record(text, "STYLE", "AcDbTextStyleTableRecord", 0x11, style_table, "Standard");
  append(text, 70, 0);
  append(text, 40, 0.0);
  append(text, 41, 1.0);
  append(text, 50, 0.0);
  append(text, 71, 0);
  append(text, 42, 0.2);
  append(text, 3, "txt");
  append(text, 4, "");
  append(text, 0, "ENDTAB");
  return text;
}

/// Tables that must be there though nothing uses them.
std::string unused_tables() {
  std::string text;
  begin_table(text, "VIEW", view_table, 0);
  append(text, 0, "ENDTAB");
  begin_table(text, "UCS", ucs_table, 0);
  append(text, 0, "ENDTAB");
  begin_table(text, "APPID", application_table, 1);
  begin_record(text, "APPID", "AcDbRegAppTableRecord", 0x12, application_table, "ACAD");
  append(text, 70, 0);
  append(text, 0, "ENDTAB");
  begin_table(text, "DIMSTYLE", dimension_style_table, 1);
  append(text, 100, "AcDbDimStyleTable");
  begin_record(text, "DIMSTYLE", "AcDbDimStyleTableRecord", 0x27, dimension_style_table,
               "Standard");
  append(text, 70, 0);
  append(text, 0, "ENDTAB");
  return text;
}

std::string block_records() {
  std::string text;
  begin_table(text, "BLOCK_RECORD", block_record_table, 2);
  begin_record(text, "BLOCK_RECORD", "AcDbBlockTableRecord", model_space, block_record_table,
               "*Model_Space");
  begin_record(text, "BLOCK_RECORD", "AcDbBlockTableRecord", paper_space, block_record_table,
               "*Paper_Space");
  append(text, 0, "ENDTAB");
  return text;
}

std::string tables(const std::vector<DxfLayer>& layers, const Eigen::AlignedBox2d& extent) {
  std::string text;
  append(text, 0, "SECTION");
  append(text, 2, "TABLES");
  text += viewport(extent) + linetypes() + layer_list(layers) + text_styles() + unused_tables() +
          block_records();
  append(text, 0, "ENDSEC");
  return text;
}

std::string blocks() {
  std::string text;
  append(text, 0, "SECTION");
  append(text, 2, "BLOCKS");
  const auto add_block = [&](unsigned handle, unsigned record, const char* name) {
    append(text, 0, "BLOCK");
    append_handle(text, 5, handle);
    append_handle(text, 330, record);
    append(text, 100, "AcDbEntity");
    append(text, 8, "0");
    append(text, 100, "AcDbBlockBegin");
    append(text, 2, name);
    append(text, 70, 0);
    append_point_in_space(text, Vector2d(0, 0));
    append(text, 3, name);
    append(text, 1, "");
    append(text, 0, "ENDBLK");
    append_handle(text, 5, handle + 1);
    append_handle(text, 330, record);
    append(text, 100, "AcDbEntity");
    append(text, 8, "0");
    append(text, 100, "AcDbBlockEnd");
  };
  add_block(0x20, model_space, "*Model_Space");
  add_block(0x1C, paper_space, "*Paper_Space");
  append(text, 0, "ENDSEC");
  return text;
}

std::string objects() {
  std::string text;
  append(text, 0, "SECTION");
  append(text, 2, "OBJECTS");
  const auto add_dictionary = [&](unsigned handle, unsigned owner) {
    append(text, 0, "DICTIONARY");
    append_handle(text, 5, handle);
    append_handle(text, 330, owner);
    append(text, 100, "AcDbDictionary");
    append(text, 281, 1);
  };
  add_dictionary(root_dictionary, 0);
  append(text, 3, "ACAD_GROUP");
  append_handle(text, 350, group_dictionary);
  add_dictionary(group_dictionary, root_dictionary);
  append(text, 0, "ENDSEC");
  return text;
}

}  // namespace

std::string before_entities(const std::vector<DxfLayer>& layers, const Eigen::AlignedBox2d& extent,
                            const std::string& comment, unsigned next_handle) {
  std::string text = header(extent, comment, next_handle);
  append(text, 0, "SECTION");
  append(text, 2, "CLASSES");
  append(text, 0, "ENDSEC");
  text += tables(layers, extent);
  text += blocks();
  append(text, 0, "SECTION");
  append(text, 2, "ENTITIES");
  return text;
}

std::string after_entities() {
  std::string text;
  append(text, 0, "ENDSEC");
  text += objects();
  append(text, 0, "EOF");
  return text;
}

}  // namespace planum::dxf
