#include "compiler/frontends/mesh/mesh_reader.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "schema/files.h"

namespace plumb::compiler {
namespace {

constexpr int kMaxDepth = 200;
constexpr const char* kMainName = "plumb-mesh";

// assimp's C interface, loaded when a mesh is read: no other plan waits for it, nor has its 3 MB in memory.
struct AssimpLibrary {
  decltype(&aiImportFileEx) import_file = nullptr;
  decltype(&aiGetErrorString) error_string = nullptr;

  // Stays until the process ends.
  static Expected<AssimpLibrary> Load() {
    AssimpLibrary out;
    void* library = dlopen(PLUMB_ASSIMP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return Fail(ErrorCode::kFileUnreadable, fmt::format("meshes cannot be read: {}", dlerror()));
    out.import_file = reinterpret_cast<decltype(out.import_file)>(dlsym(library, "aiImportFileEx"));
    out.error_string = reinterpret_cast<decltype(out.error_string)>(dlsym(library, "aiGetErrorString"));
    if (out.import_file != nullptr && out.error_string != nullptr) return out;
    return Fail(ErrorCode::kFileUnreadable, "meshes cannot be read: " PLUMB_ASSIMP_LIBRARY " is not the assimp that this program knows");
  }
};

// A file in memory, read by assimp.
class OpenFile {
 public:
  explicit OpenFile(std::string_view bytes) : bytes_(bytes) {}
  explicit OpenFile(std::string content) : content_(std::move(content)), bytes_(content_) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  aiFile* face() { return &face_; }
  static OpenFile& Of(aiFile* face) { return *reinterpret_cast<OpenFile*>(face->UserData); }

 private:
  static size_t Read(aiFile* face, char* out, size_t size, size_t count) {
    OpenFile& file = Of(face);
    if (size == 0) return 0;
    count = std::min(count, (file.bytes_.size() - file.at_) / size);
    std::copy_n(file.bytes_.data() + file.at_, size * count, out);
    file.at_ += size * count;
    return count;
  }
  static size_t Write(aiFile*, const char*, size_t, size_t) { return 0; }
  static size_t Tell(aiFile* face) { return Of(face).at_; }
  static size_t Size(aiFile* face) { return Of(face).bytes_.size(); }
  static void Flush(aiFile*) {}
  static aiReturn Seek(aiFile* face, size_t offset, aiOrigin origin) {
    OpenFile& file = Of(face);
    const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? file.at_ : file.bytes_.size();
    const size_t to = from + offset;  // back wraps around
    if (to > file.bytes_.size()) return aiReturn_FAILURE;
    file.at_ = to;
    return aiReturn_SUCCESS;
  }

  std::string content_;
  std::string_view bytes_;
  size_t at_ = 0;
  aiFile face_{Read, Write, Tell, Size, Seek, Flush, reinterpret_cast<char*>(this)};
};

// The mesh itself from memory; beside it only files of its own folder, for reading.
class FolderOnly {
 public:
  FolderOnly(std::string_view bytes, std::string main, std::string folder)
      : bytes_(bytes), main_(std::move(main)), folder_(std::move(folder)) {}

  aiFileIO face() { return {Open, Close, reinterpret_cast<char*>(this)}; }

 private:
  static aiFile* Open(aiFileIO* face, const char* file, const char* mode) {
    const FolderOnly& folder = *reinterpret_cast<FolderOnly*>(face->UserData);
    if (file == folder.main_) return (new OpenFile(folder.bytes_))->face();
    if (mode[0] != 'r' || !IsBeside(file)) return nullptr;
    auto content = ReadFileText((std::filesystem::path(folder.folder_) / Bare(file)).string());
    return content ? (new OpenFile(std::move(*content)))->face() : nullptr;
  }
  static void Close(aiFileIO*, aiFile* file) { delete &OpenFile::Of(file); }

  static std::string Bare(std::string_view file) {
    while (file.starts_with("./")) file.remove_prefix(2);
    return std::string(file);
  }
  static bool IsBeside(const char* file) {
    const std::string name = Bare(file);
    return !name.empty() && name.find("..") == std::string::npos && name[0] != '/' && name.find('\\') == std::string::npos;
  }

  std::string_view bytes_;
  std::string main_, folder_;
};

class Flattener {
 public:
  Flattener(const aiScene& scene, size_t max_triangles) : scene_(scene), max_triangles_(max_triangles) {}

  Expected<std::vector<MeshObject>> Run() {
    if (!Add(*scene_.mRootNode, aiMatrix4x4(), 0)) {
      return Fail(ErrorCode::kFileTooLarge,
                  fmt::format("it has more than {} triangles or nodes nested deeper than {}", max_triangles_, kMaxDepth));
    }
    return std::move(out_);
  }

 private:
  bool Add(const aiNode& node, const aiMatrix4x4& above, int depth) {
    if (depth > kMaxDepth) return false;
    const aiMatrix4x4 here = above * node.mTransformation;
    MeshObject object;
    object.name = node.mName.C_Str();
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[m]];
      if (object.name.empty()) object.name = mesh.mName.C_Str();
      if (!AddMesh(mesh, here, object.solid)) return false;
    }
    if (!object.solid.empty()) out_.push_back(std::move(object));
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      if (!Add(*node.mChildren[c], here, depth + 1)) return false;
    }
    return true;
  }

  bool AddMesh(const aiMesh& mesh, const aiMatrix4x4& T_out_mesh, Solid& solid) {
    triangles_ += mesh.mNumFaces;
    if (triangles_ > max_triangles_) return false;
    const int base = static_cast<int>(solid.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = T_out_mesh * mesh.mVertices[v];
      solid.vertices.emplace_back(p.x, p.y, p.z);
    }
    const bool mirrored = T_out_mesh.Determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      const Eigen::Vector3i t(static_cast<int>(face.mIndices[0]), static_cast<int>(face.mIndices[1]), static_cast<int>(face.mIndices[2]));
      solid.triangles.push_back((mirrored ? Eigen::Vector3i(t[0], t[2], t[1]) : t).array() + base);
    }
    return true;
  }

  const aiScene& scene_;
  size_t max_triangles_, triangles_ = 0;
  std::vector<MeshObject> out_;
};

template <class T>
void Put(const T& value, std::string& out) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  bool Get(T& value) {
    return GetRaw(&value, sizeof value);
  }
  bool GetRaw(void* out, size_t size) {
    if (bytes_.size() < size) return false;
    if (size > 0) std::memcpy(out, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return true;
  }
  [[nodiscard]] size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

bool GetObject(Cursor& in, MeshObject& object) {
  uint32_t name = 0, vertices = 0, triangles = 0;
  if (!in.Get(name) || name > in.left()) return false;
  object.name.resize(name);
  if (!in.GetRaw(object.name.data(), name) || !in.Get(vertices) || vertices > in.left() / sizeof(Eigen::Vector3d)) return false;
  object.solid.vertices.resize(vertices);
  if (!in.GetRaw(object.solid.vertices.data(), vertices * sizeof(Eigen::Vector3d))) return false;
  if (!in.Get(triangles) || triangles > in.left() / sizeof(Eigen::Vector3i)) return false;
  object.solid.triangles.resize(triangles);
  if (!in.GetRaw(object.solid.triangles.data(), triangles * sizeof(Eigen::Vector3i))) return false;
  const int size = static_cast<int>(vertices);
  for (const Eigen::Vector3i& t : object.solid.triangles) {
    if (t.minCoeff() < 0 || t.maxCoeff() >= size) return false;
  }
  return true;
}

}  // namespace

Expected<std::vector<MeshObject>> ReadWithAssimp(std::string_view bytes, const std::string& hint, const std::string& folder,
                                                 size_t max_triangles) {
  const auto assimp = AssimpLibrary::Load();
  if (!assimp) return tl::unexpected<Error>(assimp.error());
  const std::string main = std::string(kMainName) + "." + hint;
  FolderOnly files(bytes, main, folder);
  aiFileIO io = files.face();
  const aiScene* scene = assimp->import_file(main.c_str(), aiProcess_Triangulate | aiProcess_SortByPType, &io);
  if (scene == nullptr || scene->mRootNode == nullptr) return Fail(ErrorCode::kFileUnreadable, assimp->error_string());
  return Flattener(*scene, max_triangles).Run();
}

std::string EncodeObjects(const std::vector<MeshObject>& objects) {
  std::string out;
  Put(static_cast<uint32_t>(objects.size()), out);
  for (const MeshObject& o : objects) {
    Put(static_cast<uint32_t>(o.name.size()), out);
    out += o.name;
    Put(static_cast<uint32_t>(o.solid.vertices.size()), out);
    out.append(reinterpret_cast<const char*>(o.solid.vertices.data()), o.solid.vertices.size() * sizeof(Eigen::Vector3d));
    Put(static_cast<uint32_t>(o.solid.triangles.size()), out);
    out.append(reinterpret_cast<const char*>(o.solid.triangles.data()), o.solid.triangles.size() * sizeof(Eigen::Vector3i));
  }
  return out;
}

Expected<std::vector<MeshObject>> DecodeObjects(std::string_view bytes) {
  Cursor in(bytes);
  uint32_t count = 0;
  const auto damaged = [] { return Fail(ErrorCode::kFileUnreadable, "what the mesh reader sent is damaged"); };
  if (!in.Get(count)) return damaged();
  std::vector<MeshObject> out;
  for (uint32_t i = 0; i < count; ++i) {
    MeshObject object;
    if (!GetObject(in, object)) return damaged();
    out.push_back(std::move(object));
  }
  if (in.left() != 0) return damaged();
  return out;
}

}  // namespace plumb::compiler
