#pragma once

#include <string>

namespace lowlap::testing {

/// A file as OpenMVG writes it: two views of one K3 camera, with one landmark,
/// in hash order and with OpenMVG's layout. The pixels are the landmark's
/// projections, rounded to 1e-6.
inline std::string OpenMvgWorkedExample() {
  return R"({
    "sfm_data_version": "0.3",
    "root_path": "/data/images",
    "views": [
        {
            "key": 1,
            "value": {
                "polymorphic_id": 1073741824,
                "ptr_wrapper": {
                    "id": 2147483649,
                    "data": {
                        "local_path": "sub",
                        "filename": "b.jpg",
                        "width": 640,
                        "height": 480,
                        "id_view": 1,
                        "id_intrinsic": 0,
                        "id_pose": 1
                    }
                }
            }
        },
        {
            "key": 0,
            "value": {
                "polymorphic_id": 1073741824,
                "ptr_wrapper": {
                    "id": 2147483650,
                    "data": {
                        "local_path": "",
                        "filename": "a.jpg",
                        "width": 640,
                        "height": 480,
                        "id_view": 0,
                        "id_intrinsic": 0,
                        "id_pose": 0
                    }
                }
            }
        }
    ],
    "intrinsics": [
        {
            "key": 0,
            "value": {
                "polymorphic_id": 2147483649,
                "polymorphic_name": "pinhole_radial_k3",
                "ptr_wrapper": {
                    "id": 2147483651,
                    "data": {
                        "width": 640,
                        "height": 480,
                        "focal_length": 500.0,
                        "principal_point": [
                            320.0,
                            240.0
                        ],
                        "disto_k3": [
                            -0.1,
                            0.01,
                            0.0
                        ]
                    }
                }
            }
        }
    ],
    "extrinsics": [
        {
            "key": 1,
            "value": {
                "rotation": [
                    [
                        0.8,
                        0.0,
                        -0.6
                    ],
                    [
                        0.0,
                        1.0,
                        0.0
                    ],
                    [
                        0.6,
                        0.0,
                        0.8
                    ]
                ],
                "center": [
                    -3.0,
                    0.0,
                    1.0
                ]
            }
        },
        {
            "key": 0,
            "value": {
                "rotation": [
                    [
                        1.0,
                        0.0,
                        0.0
                    ],
                    [
                        0.0,
                        1.0,
                        0.0
                    ],
                    [
                        0.0,
                        0.0,
                        1.0
                    ]
                ],
                "center": [
                    0.0,
                    0.0,
                    0.0
                ]
            }
        }
    ],
    "structure": [
        {
            "key": 0,
            "value": {
                "X": [
                    0.5,
                    -0.25,
                    5.0
                ],
                "observations": [
                    {
                        "key": 1,
                        "value": {
                            "id_feat": 9,
                            "x": [
                                357.705982,
                                216.433761
                            ]
                        }
                    },
                    {
                        "key": 0,
                        "value": {
                            "id_feat": 7,
                            "x": [
                                369.937578,
                                215.031211
                            ]
                        }
                    }
                ]
            }
        }
    ],
    "control_points": []
})";
}

/// `text` with the first `from` replaced; `from` must be there.
inline std::string Replaced(std::string text, const std::string& from,
                            const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return "no \"" + from + "\" in the text";
  return text.replace(begin, from.size(), to);
}

}  // namespace lowlap::testing
