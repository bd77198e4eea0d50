#pragma once

#include "Picture.h"

/** \file Compose.h
 * From layers to a picture. */
namespace taut
{
/** Darkens points that lie behind their neighbours in the picture, the more the larger the step in
 * depth: edges become visible in a cloud without normals. Steps of less than `tolerance` [m] do not
 * count. After C. Boucheny's eye-dome lighting (thesis, Universite Joseph Fourier, Grenoble,
 * 2009). */
void shadeByDepth(Layer& layer, const ViewCamera& camera, int radius, double tolerance);

/** Paints what was drawn in `layer` over a picture of the same size; with the given opacity where
 * `hider` is nearer to the camera. */
void paintOver(Picture& picture, const Layer& layer, const Layer& hider, double opacity_if_hidden);

/** The picture with `factor` x `factor` pixels averaged to one. */
Picture averagedDown(const Picture& picture, int factor);

/** Prints the dark parts of `ink`, of the same size, on the picture, with a light rim of some
 * pixels that keeps them legible on any ground. */
void print(Picture& picture, const Picture& ink, int rim);
}  // namespace taut
