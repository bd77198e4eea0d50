#pragma once

#include <string>
#include <vector>

#include "Offscreen.h"
#include "taut/render/PointCloud.h"

/** \file Legend.h
 * The words and measures of a picture. */
namespace taut
{
/** The largest of 1, 2 and 5 times a power of ten that is not above `limit` (> 0). */
double roundNumber(double limit);

/** A length as text: "5 m", "0.2 m", "2 km". */
std::string lengthText(double metres);

/** Words to be printed on a picture, at the left end of their base line [pixels]. */
struct Words
{
    std::string text;
    double x = 0, y = 0;
    double height = 15;  //!< of the font [pixels]

    double width() const;
};

/** Prints all words on the picture. */
void printWords(
    Picture& picture, const std::vector<Words>& words, Offscreen& offscreen, int supersampling);

/** The strip below the picture: caption, scale, heights. */
struct Legend
{
    std::vector<std::string> caption;
    Span heights;                 //!< [m]; of size 0 if there is no map
    double metres_per_pixel = 0;  //!< of an orthographic view, for the scale bar; 0 in perspective
    double grid_step = 1;         //!< [m]

    /** Height of the strip [pixels] in a picture of that size. */
    int height(PixelSize picture) const;

    /** Draws bars into the lowest part of the picture and gives the words that belong there. */
    std::vector<Words> draw(Picture& picture) const;

 private:
    double font(PixelSize picture) const;
};
}  // namespace taut
