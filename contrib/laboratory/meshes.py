"""Settings of cells that several studies sweep; h is a size in mean grain diameters."""


def cells(h):
    """The same size everywhere."""
    return {"Mesh refinement/Criteria": "uniform", "Mesh refinement/Criteria: uniform/Cell size": h,
            "Mesh refinement/Coarsest cell size": max(8, h), "Mesh refinement/Interval": 0}


def at_faces(h):
    """This size at the faces of the bed; elsewhere the scene's."""
    return {"Mesh refinement/Criteria: bed faces/Cell size at the bottom": h, "Mesh refinement/Criteria: bed faces/Cell size at the top": h}
