"""What pictures share: lights, letters, the scale, and the file that they go to. Needs a display."""

import vtk
from vtk.util.numpy_support import numpy_to_vtk

TEXT_COLOUR = (0.15, 0.15, 0.15)
PANEL = 0.5  # opacity of what stands behind letters: what a camera that follows passes is seen under them
# Heights of letters in pictures of 1600 x 1000 pixels.
TITLE_LETTERS, SCALE_LETTERS = 26, 22
# Drawn larger by this factor and averaged: Mesa's software renderer shows black through VTK's own FXAA.
SMOOTHING = 2


def empty_picture(backdrop):
    """Renderer of a picture before a "sky" or "white"."""
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    if backdrop == "sky":
        renderer.SetBackground2(0.80, 0.86, 0.93)
        renderer.GradientBackgroundOn()
    return renderer


def add_lights(renderer):
    kit = vtk.vtkLightKit()
    kit.SetKeyLightIntensity(0.85)
    kit.SetKeyToFillRatio(2.5)
    kit.AddLightsToRenderer(renderer)


def mesh_actor(data):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def add_scale(renderer, shades, size):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(shades.table)
    bar.SetTitle(shades.title)
    bar.UseCustomLabelsOn()
    bar.SetCustomLabels(numpy_to_vtk(shades.labels, deep=True))
    bar.SetLabelFormat("  %-.3g")
    bar.SetPosition(0.88, 0.18)
    bar.SetPosition2(0.10, 0.55)
    bar.SetBarRatio(0.25)
    bar.SetVerticalTitleSeparation(round(14 * size[1] / 1000))
    bar.UnconstrainedFontSizeOn()
    bar.DrawBackgroundOn()
    bar.GetBackgroundProperty().SetColor(1.0, 1.0, 1.0)
    bar.GetBackgroundProperty().SetOpacity(PANEL)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        plain(text, SCALE_LETTERS, size)
    renderer.AddActor2D(bar)


def add_title(renderer, text, size):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    plain(actor.GetTextProperty(), TITLE_LETTERS, size)
    actor.GetTextProperty().SetVerticalJustificationToTop()
    actor.GetTextProperty().SetLineSpacing(1.3)
    actor.GetTextProperty().SetBackgroundColor(1.0, 1.0, 1.0)
    actor.GetTextProperty().SetBackgroundOpacity(PANEL)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(0.015, 0.98)
    renderer.AddActor2D(actor)


def plain(text, letters, size):
    text.SetFontFamilyToArial()
    text.SetFontSize(round(SMOOTHING * letters * min(size[1] / 1000, size[0] / 1600)))
    text.SetColor(*TEXT_COLOUR)
    text.BoldOff()
    text.ItalicOff()
    text.ShadowOff()


def write(renderer, output, size):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SMOOTHING * size[0], SMOOTHING * size[1])
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    mean = vtk.vtkImageShrink3D()
    mean.SetInputConnection(image.GetOutputPort())
    mean.SetShrinkFactors(SMOOTHING, SMOOTHING, 1)
    mean.MeanOn()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(output))
    writer.SetInputConnection(mean.GetOutputPort())
    writer.Write()
