// SPDX-License-Identifier: Apache-2.0
#include "shading/textures.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "scene/coat.h"
#include "scene/mesh.h"
#include "scene/texture_mapping.h"
#include "shading/anisotropic_lobe.h"
#include "shading/models_at_hit.h"
#include "shading/texture_kernels.h"

namespace nacre {
namespace {

bool SameCoordinates(const Texture& a, const Texture& b) {
  const auto key = [](const Texture& t) {
    return std::make_tuple(t.mapping, t.axis.x, t.axis.y, t.axis.z, t.rotate_deg, t.center.x,
                           t.center.y, t.center.z, t.size, t.scale.x, t.scale.y, t.uv_rotate_deg,
                           t.offset.x, t.offset.y, t.second_uvs);
  };
  return key(a) == key(b);
}

// Prepares the tangents of each normal map on each mesh. Textures that rotate coordinates by the
// same angle share them, however they scale coordinates.
void PrepareTangents(int threads, KeptTables* kept, TextureScene* prepared) {
  const Scene& scene = *prepared->scene;
  struct Made {
    bool second_uvs;
    UvRows rows;
    uint32_t index;
  };
  std::vector<Made> made;  // the tangents made for the current mesh
  const auto prepare_map = [&](TextureId map, size_t number) {
    if (!map.valid()) return;
    const PreparedTexture& texture = prepared->textures[map.index];
    const Mesh& mesh = scene.meshes[number];
    if (texture.mapping != MappingKind::kUv || mesh.uvs.empty()) return;
    prepared->mesh_tangents.resize(scene.meshes.size());
    std::vector<MapTangents>& of_mesh = prepared->mesh_tangents[number];
    const std::vector<Vec2d>& uvs = UvsOf(mesh, texture.second_uvs);
    const bool second = &uvs == &mesh.second_uvs;
    const UvRows rows = RowsOfSameTangents({texture.u_row, texture.v_row});
    const auto known = std::find_if(made.begin(), made.end(), [&](const Made& other) {
      return other.second_uvs == second && other.rows == rows;
    });
    if (known != made.end()) {
      of_mesh.push_back({map.index, known->index});
      return;
    }
    const auto index = static_cast<uint32_t>(prepared->tangents.size());
    of_mesh.push_back({map.index, index});
    made.push_back({second, rows, index});
    const auto before =
        std::find_if(kept->tangents.begin(), kept->tangents.end(), [&](const KeptTangents& other) {
          return other.mesh == number && other.second_uvs == second && other.rows == rows;
        });
    if (before != kept->tangents.end()) {
      prepared->tangents.push_back(before->tangents);
      return;
    }
    prepared->tangents.push_back(std::make_shared<const CornerTangents>(
        !mesh.tangents.empty() && HasSmoothNormals(mesh) ? RotateTangents(mesh, rows)
                                                         : MakeTangents(mesh, uvs, rows, threads)));
    kept->tangents.push_back({number, second, rows, prepared->tangents.back()});
  };
  const auto prepare = [&](MaterialId id, size_t number) {
    const Material& material = scene.materials[id.index];
    for (const MaterialNormalMap& row : ModelOf(material)->normal_maps) {
      prepare_map(NormalMapOf(row, material).texture, number);
    }
    const auto anisotropic = [&](const Material& of) {
      if (!IsAnisotropic(of)) return;
      const TextureId map = TangentTurnOf(of).coordinates;
      const auto own = static_cast<uint32_t>(prepared->textures.size() - 1);
      prepare_map(map.valid() ? map : TextureId{own}, number);
    };
    anisotropic(material);
    for (const Coat& coat : CoatsOf(material)) anisotropic(coat.material);
  };
  for (size_t number = 0; number < scene.meshes.size(); ++number) {
    made.clear();
    const MaterialId material = scene.meshes[number].material;
    const auto* split = std::get_if<SplitMaterial>(&scene.materials[material.index].model);
    if (split == nullptr) {
      prepare(material, number);
    } else {
      for (const MaterialId part : split->materials) prepare(part, number);
    }
  }
}

// The value of RunTexturer::made_ before any coordinates are made.
constexpr size_t kNone = static_cast<size_t>(-1);

class RunTexturer {
 public:
  explicit RunTexturer(const TexturedRun& run) : run_(run), t_(run.textures) {}

  void Texture() {
    FindPoints(run_);
    const Material& material = *run_.material.scene_material;
    if (material.normal_map.texture.valid()) ApplyNormalMap(material.normal_map);
    if (material.bump_map.texture.valid()) ApplyBumpMap(material.bump_map);
    if (run_.material.by_hit.tangent) FindTangent(TangentTurnOf(material));
    // Without maps of parameters only the tangent is wanted.
    if (!run_.material.by_hit.parameters) return;
    const MaterialModel& model = *ModelOf(material);
    StartNumbers(run_);
    if (material.vertex_colors == VertexColors::kBase) {
      MultiplyByVertexColors(model, MappedNumber::kColor);
    }
    for (const MaterialMap& map : model.maps) {
      if (map.target_count == 0 || !map.get(material).valid()) continue;
      LookUp(map.get(material));
      for (const MapTarget& target : TargetsOf(map)) MultiplyNumber(run_, target);
    }
    if (material.vertex_colors == VertexColors::kEmission) {
      MultiplyByVertexColors(model, MappedNumber::kEmission);
    }
    FinishNumbers(run_);
    if (run_.material.in_ambient) CoverAmbient();
  }

 private:
  const PreparedTexture& FindCoordinates(TextureId id) {
    return FindCoordinates(run_.scene.textures[id.index]);
  }

  const PreparedTexture& FindCoordinates(const PreparedTexture& texture) {
    if (texture.coordinates != made_) MakeCoordinates(run_, texture);
    made_ = texture.coordinates;
    return texture;
  }

  SamplePoints Points() const {
    const size_t i = run_.begin;
    return {t_.u.data() + i,
            t_.v.data() + i,
            {t_.du_dx.data() + i, t_.dv_dx.data() + i, t_.du_dy.data() + i, t_.dv_dy.data() + i},
            run_.end - run_.begin};
  }

  void LookUp(TextureId id) {
    const PreparedTexture& texture = FindCoordinates(id);
    const size_t i = run_.begin;
    float* const to[3] = {t_.texels.x.data() + i, t_.texels.y.data() + i, t_.texels.z.data() + i};
    SampleTexture(*texture.image, texture.sampling, Points(), 3, to);
  }

  void MultiplyByVertexColors(const MaterialModel& model, MappedNumber number) {
    for (const MaterialMap& map : model.maps) {
      for (const MapTarget& target : TargetsOf(map)) {
        if (target.number != number) continue;
        FindVertexColors(run_);
        return MultiplyNumber(run_, target);
      }
    }
  }

  void ApplyNormalMap(const NormalMap& map) {
    LookUp(map.texture);
    const bool literal = map.convention == NormalMap::Convention::kLiteral;
    const float middle = literal ? 0.5f : run_.scene.textures[map.texture.index].middle;
    const bool frames = FindTangents(run_, run_.scene.textures[map.texture.index]);
    MapNormals(run_, middle, static_cast<float>(map.scale), frames);
  }

  void ApplyBumpMap(const BumpMap& map) {
    const PreparedTexture& texture = FindCoordinates(map.texture);
    const size_t i = run_.begin;
    SampleSlopes(*texture.image, texture.sampling, Points(), t_.texels.x.data() + i,
                 t_.texels.y.data() + i);
    MapNormalsBySlopes(run_, map.distance);
  }

  void FindTangent(const TangentTurn& turn) {
    const bool by_map = turn.direction.valid();
    if (by_map) LookUp(turn.direction);
    const PreparedTexture& texture =
        FindCoordinates(turn.coordinates.valid() ? run_.scene.textures[turn.coordinates.index]
                                                 : ShapeCoordinates(run_.scene));
    StoreTangents(run_, FindTangents(run_, texture), by_map);
  }

  // Each layer below the coats reflects its albedo of ambient light, and attenuates what is
  // reflected below it.
  void CoverAmbient() {
    const ShadingMaterial& material = run_.material;
    const HitParameters* const maps = material.by_hit.model ? &t_ : nullptr;
    for (const LayerModel& layer : material.layers) {
      if (LiesOverCoats(layer)) continue;
      for (size_t i = run_.begin; i < run_.end; ++i) {
        const LayerReflection albedo =
            LayerAlbedo(LayerAtHit(layer, maps, i), NDotV(run_.surface, i));
        for (int c = 0; c < 3; ++c) {
          float& ambient = ChannelOf(t_.ambient, c)[i];
          ambient =
              static_cast<float>(albedo.below * ambient + albedo.lobe[c] * run_.scene.ambient[c]);
        }
      }
    }
  }

  const TexturedRun& run_;
  HitParameters& t_;
  size_t made_ = kNone;
};

}  // namespace

TextureScene PrepareTextures(const Scene& scene, double footprint, int threads, KeptTables* kept) {
  // Drops tangents that no plan uses any more, such as those of a rotation that a slider has
  // passed.
  std::erase_if(kept->tangents,
                [](const KeptTangents& entry) { return entry.tangents.use_count() == 1; });
  TextureScene prepared;
  prepared.scene = &scene;
  prepared.footprint = footprint;
  prepared.textures.reserve(scene.textures.size() + 1);
  const auto prepare = [&](const Texture& texture) {
    PreparedTexture& to = prepared.textures.emplace_back();
    to.image = nullptr;
    to.sampling = texture.sampling;
    to.mapping = texture.mapping;
    to.second_uvs = texture.second_uvs;
    to.middle = 0;
    const MappingFrame frame = FrameOf(texture);
    to.frame[0] = frame.x;
    to.frame[1] = frame.y;
    to.frame[2] = frame.z;
    to.center = texture.center - scene.camera.position;
    to.inverse_size = 1 / texture.size;
    const UvTransform transform = TransformOf(texture);
    to.u_row = transform.u_row;
    to.v_row = transform.v_row;
    to.offset = transform.offset;
    const auto same =
        std::find_if(scene.textures.begin(), scene.textures.end(),
                     [&](const Texture& other) { return SameCoordinates(other, texture); });
    to.coordinates = static_cast<size_t>(same - scene.textures.begin());
  };
  for (const Texture& texture : scene.textures) {
    prepare(texture);
    const SceneImage& image = scene.images[texture.image.index];
    prepared.textures.back().image = image.texels.get();
    prepared.textures.back().middle = image.middle;
  }
  prepare(Texture{});
  prepared.primitives = NumberPrimitives(scene);
  PrepareTangents(threads, kept, &prepared);
  return prepared;
}

void TextureHits(const TexturedRun& run) { RunTexturer(run).Texture(); }

}  // namespace nacre
