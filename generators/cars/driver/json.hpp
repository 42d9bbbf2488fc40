// Reading and writing of the small JSON files by which the driver is told what to do.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "chrono/core/ChVector3.h"
#include "chrono_thirdparty/rapidjson/document.h"
#include "chrono_thirdparty/rapidjson/prettywriter.h"
#include "chrono_thirdparty/rapidjson/stringbuffer.h"

namespace json {

using Value = rapidjson::Value;

inline rapidjson::Document read(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error(path + ": cannot be read");
    std::stringstream text;
    text << file.rdbuf();
    rapidjson::Document document;
    document.Parse(text.str().c_str());
    if (document.HasParseError() || !document.IsObject())
        throw std::runtime_error(path + ": is not a JSON object");
    return document;
}

inline bool has(const Value& object, const char* key) {
    return object.HasMember(key) && !object[key].IsNull();
}

inline const Value& member(const Value& object, const char* key) {
    if (!has(object, key))
        throw std::runtime_error(std::string(key) + " is missing");
    return object[key];
}

inline double number(const Value& object, const char* key) {
    const Value& value = member(object, key);
    if (!value.IsNumber())
        throw std::runtime_error(std::string(key) + " is not a number");
    return value.GetDouble();
}

inline double number_or(const Value& object, const char* key, double otherwise) {
    return has(object, key) ? number(object, key) : otherwise;
}

inline bool flag_or(const Value& object, const char* key, bool otherwise) {
    return has(object, key) ? object[key].GetBool() : otherwise;
}

inline std::string text(const Value& object, const char* key) {
    const Value& value = member(object, key);
    if (!value.IsString())
        throw std::runtime_error(std::string(key) + " is not a text");
    return value.GetString();
}

inline std::vector<double> numbers(const Value& object, const char* key, size_t expected = 0) {
    const Value& value = member(object, key);
    if (!value.IsArray() || (expected > 0 && value.Size() != expected))
        throw std::runtime_error(std::string(key) + " is not a list of the right length");
    std::vector<double> list;
    for (const auto& item : value.GetArray())
        list.push_back(item.GetDouble());
    return list;
}

inline chrono::ChVector3d vector(const Value& object, const char* key) {
    const auto list = numbers(object, key, 3);
    return {list[0], list[1], list[2]};
}

// Writes one JSON object, which may hold others, to a file.
class Writer {
  public:
    Writer() : m_writer(m_buffer) { m_writer.StartObject(); }

    void number(const char* key, double value) {
        m_writer.Key(key);
        plain(value);
    }
    void flag(const char* key, bool value) {
        m_writer.Key(key);
        m_writer.Bool(value);
    }
    void numbers(const char* key, const std::vector<double>& values) {
        m_writer.Key(key);
        m_writer.StartArray();
        for (double value : values)
            plain(value);
        m_writer.EndArray();
    }
    void begin_list(const char* key) {
        m_writer.Key(key);
        m_writer.StartArray();
    }
    void end_list() { m_writer.EndArray(); }
    void begin_object() { m_writer.StartObject(); }
    void end_object() { m_writer.EndObject(); }

    void save(const std::string& path) {
        m_writer.EndObject();
        std::ofstream file(path);
        file << m_buffer.GetString() << "\n";
        if (!file)
            throw std::runtime_error(path + ": cannot be written");
    }

  private:
    // A value that is not finite has no place in JSON.
    void plain(double value) {
        if (std::isfinite(value))
            m_writer.Double(value);
        else
            m_writer.Null();
    }

    rapidjson::StringBuffer m_buffer;
    rapidjson::PrettyWriter<rapidjson::StringBuffer> m_writer;
};

}  // namespace json
