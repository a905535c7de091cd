"""New packages of plug-ins, written from templates."""
