"""The panel beside the photo: HTML, viser controls."""
