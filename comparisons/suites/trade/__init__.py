"""What accuracy costs: settings of every model on one scene, their errors and their seconds."""
